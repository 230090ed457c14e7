#include "msa/base/part_file.h"
#include "msa/base/index.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <optional>
#include <system_error>

namespace deflect {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view mark = ".part";

/// The process that made the part file of `target`; nothing where the name is not of that form.
std::optional<pid_t> maker(std::string_view name, std::string_view target) {
  if (!name.starts_with(target)) return {};
  name.remove_prefix(target.size());
  if (!name.starts_with(mark)) return {};
  name.remove_prefix(mark.size());
  pid_t process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  if (error != std::errc() || process <= 0) return {};
  name.remove_prefix(as_size(end - name.data()));
  if (name.starts_with('-')) {  // several of one process are counted
    name.remove_prefix(1);
    const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
    if (digits == 0) return {};
    name.remove_prefix(digits);
  }
  const bool suffix = name.starts_with('.') && name.find('.', 1) == name.npos;
  return name.empty() || suffix ? std::optional(process) : std::nullopt;
}

bool other_alive(pid_t process) {
  if (process == ::getpid()) return false;
  return ::kill(process, 0) == 0 || errno == EPERM;
}

/// True also where the file system knows no locks: then the process decides alone.
bool lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

/// Whether the name still leads to the open file: it may have been renamed, or taken for one that was left.
bool is_there(int descriptor, const fs::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

void remove_if_left(const fs::path& part) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  const bool left = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && lock(descriptor);
  // A file that was renamed since it was opened is no longer locked, and its name may be that of a newer one.
  if (left && is_there(descriptor, part)) ::unlink(part.c_str());
  ::close(descriptor);
}

void remove_left_over(const fs::path& target) {
  const std::string name = target.filename().string();
  std::error_code error;
  for (fs::directory_iterator at(target.has_parent_path() ? target.parent_path() : fs::path("."), error), end;
       !error && at != end; at.increment(error))
    if (const auto process = maker(at->path().filename().string(), name); process && !other_alive(*process))
      remove_if_left(at->path());
}

}  // namespace

PartFile::PartFile(const fs::path& target, const std::string& suffix, mode_t mode) {
  remove_left_over(target);
  for (int count = 1;; ++count) {
    path_ = target;
    path_ += fmt::format("{}{}{}{}", mark, ::getpid(), count > 1 ? fmt::format("-{}", count) : "", suffix);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor_ < 0 && errno == EEXIST && count < 1000) continue;
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category());
    if (lock(descriptor_) && is_there(descriptor_, path_)) return;
    ::close(descriptor_);
  }
}

PartFile::~PartFile() {
  if (!path_.empty()) ::unlink(path_.c_str());
  ::close(descriptor_);
}

void PartFile::rename_to(const fs::path& target) {
  fs::rename(path_, target);
  path_.clear();
}

}  // namespace deflect
