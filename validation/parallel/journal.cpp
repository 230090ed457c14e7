#include "validation/parallel/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string_view>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "validation/parallel/pack.h"

namespace deflect::parallel {
namespace {

constexpr std::string_view kind_of_file = "deflect journal 1\n";

[[noreturn]] void refuse_journal(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

/// FNV-1a of the bytes, 64 bits: tells a part that was not written to its end, not one that somebody forged.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = 14695981039346656037u;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return sum;
}

std::string number_bytes(std::uint64_t n) { return {reinterpret_cast<const char*>(&n), sizeof n}; }

std::uint64_t number_at(std::string_view text, std::size_t at) {
  std::uint64_t n = 0;
  std::memcpy(&n, text.data() + at, sizeof n);
  return n;
}

/// Number, length, bytes, checksum of all of these.
std::string part_text(std::uint64_t number, const std::string& bytes) {
  const std::string text = number_bytes(number) + number_bytes(bytes.size()) + bytes;
  return text + number_bytes(checksum(text));
}

/// The length of the part that begins here; 0 where none does that is whole.
std::size_t length_of_part(std::string_view text, std::size_t at) {
  constexpr std::size_t frame = 3 * sizeof(std::uint64_t);
  const std::size_t left = text.size() - at;
  if (left < frame) return 0;
  const std::uint64_t bytes = number_at(text, at + 8);
  if (bytes > left - frame) return 0;
  const std::size_t sum_at = at + 16 + bytes;
  return checksum(text.substr(at, 16 + bytes)) == number_at(text, sum_at) ? frame + bytes : 0;
}

/// The first line in which two heads differ, for the message.
std::string different_line(const std::string& kept, const std::string& now) {
  const auto line_at = [](const std::string& text, std::size_t from) {
    return from < text.size() ? text.substr(from, text.find('\n', from) - from) : std::string("nothing");
  };
  std::size_t at = 0;
  while (at < std::min(kept.size(), now.size()) && line_at(kept, at) == line_at(now, at))
    at += line_at(now, at).size() + 1;
  return fmt::format("it has '{}', this run '{}'", line_at(kept, at), line_at(now, at));
}

}  // namespace

Journal::Journal(std::filesystem::path file, const std::string& head, const Ranks* ranks) : file_(std::move(file)) {
  if (ranks && !ranks->first()) return;
  open_.number = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (open_.number < 0) refuse_journal(file_, fmt::format("cannot be written ({})", std::strerror(errno)));
  struct stat status {};
  if (::fstat(open_.number, &status) != 0 || !S_ISREG(status.st_mode))
    refuse_journal(file_, "is no regular file, as a journal must be");
  // Where the file system knows no locks, nobody is kept out.
  if (::flock(open_.number, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse_journal(file_, "another run writes into this journal");
  read(head);
}

Journal::OpenFile::~OpenFile() {
  if (number >= 0) ::close(number);
}

void Journal::read(const std::string& head) {
  const std::string text = read_text(file_);
  const std::string begin = std::string(kind_of_file) + part_text(head.size(), head);
  if (!text.starts_with(kind_of_file) && !std::string_view(begin).starts_with(text))
    refuse_journal(file_, "is no journal of an interrupted run; name a new file");
  const std::size_t head_length = text.size() > kind_of_file.size() ? length_of_part(text, kind_of_file.size()) : 0;
  std::size_t at = 0;
  if (head_length > 0) {
    const std::string kept = text.substr(kind_of_file.size() + 16, head_length - 24);
    if (kept != head)
      refuse_journal(file_, fmt::format("is the journal of other work: {}. Give the command as it was, or remove the "
                                        "file",
                                        different_line(kept, head)));
    at = kind_of_file.size() + head_length;
    std::set<std::uint64_t> seen;
    while (const std::size_t length = length_of_part(text, at)) {
      const std::uint64_t number = number_at(text, at);
      if (seen.insert(number).second) parts_.emplace_back(number, text.substr(at + 16, length - 24));
      at += length;
    }
  }
  if (at < text.size() && ::ftruncate(open_.number, static_cast<off_t>(at)) != 0)
    refuse_journal(file_, fmt::format("cannot be written ({})", std::strerror(errno)));
  if (at == 0) write(begin);
}

void Journal::write(const std::string& text) {
  for (std::string_view left = text; !left.empty();) {
    const ssize_t n = ::write(open_.number, left.data(), left.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse_journal(file_, fmt::format("cannot be written ({})", std::strerror(errno)));
    left.remove_prefix(as_size(n));
  }
}

std::vector<std::uint64_t> Journal::take(std::uint64_t first, std::uint64_t end,
                                         const std::function<void(std::uint64_t, const std::string&)>& to) {
  std::vector<std::uint64_t> taken;
  std::erase_if(parts_, [&](const auto& part) {
    if (part.first < first || part.first >= end) return false;
    to(part.first, part.second);
    taken.push_back(part.first);
    return true;
  });
  return taken;
}

void Journal::add(std::uint64_t number, const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  write(part_text(number, bytes));
}

void Journal::remove() {
  std::error_code ignored;
  if (open_.number >= 0) std::filesystem::remove(file_, ignored);
}

void for_each_case(const SharedCases& cases, Journal* journal, std::uint64_t first, Ranks* ranks, int threads,
                   const std::function<void(std::size_t)>& told) {
  if (!journal) return for_each_case(cases, ranks, threads, told);
  std::vector<std::uint64_t> kept =
      journal->take(first, first + cases.count,
                    [&](std::uint64_t number, const std::string& bytes) { cases.take(number - first, bytes); });
  if (ranks) kept = unpack<std::vector<std::uint64_t>>(ranks->meet("", pack(kept)).said);
  const std::set<std::uint64_t> done(kept.begin(), kept.end());
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cases.count; ++i)
    if (!done.contains(first + i)) left.push_back(i);
  const bool keeps = !ranks || ranks->first();
  SharedCases rest;
  rest.count = left.size();
  rest.work = [&](std::size_t k) {
    cases.work(left[k]);
    if (keeps) journal->add(first + left[k], cases.result(left[k]));
  };
  rest.result = [&](std::size_t k) { return cases.result(left[k]); };
  rest.take = [&](std::size_t k, const std::string& bytes) {
    cases.take(left[k], bytes);
    journal->add(first + left[k], bytes);
  };
  const auto told_of_all = [&](std::size_t now) { told(done.size() + now); };
  for_each_case(rest, ranks, threads, told ? std::function<void(std::size_t)>(told_of_all) : nullptr);
}

}  // namespace deflect::parallel
