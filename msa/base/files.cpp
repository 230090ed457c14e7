#include "msa/base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/part_file.h"

namespace deflect {
namespace {
namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: cannot be written ({})", path.string(), reason));
}

std::vector<fs::path>& kept_as_they_are() {
  static std::vector<fs::path> all;
  return all;
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// An open file that is closed in the end.
class Opened {
 public:
  Opened(const fs::path& path, int flags) : descriptor_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category());
  }
  ~Opened() { ::close(descriptor_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(descriptor, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::generic_category());
    text.remove_prefix(as_size(n));
  }
}

/// What a path leads to, links followed.
struct Target {
  fs::path path;
  std::optional<struct stat> there;  ///< none: there is no file yet
  std::optional<int> own;            ///< a descriptor that this process holds, as /dev/stdout is

  bool regular() const { return !own && (!there || S_ISREG(there->st_mode)); }
};

/// 1 for /proc/self/fd/1 and its like, whose links lead to what no path names.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code error;
  const std::string folder = fs::canonical(folder_of(path), error).string();
  if (error || !folder.starts_with(fmt::format("/proc/{}/", ::getpid())) || !folder.ends_with("/fd")) return {};
  const std::string name = path.filename().string();
  int number = 0;
  const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (wrong != std::errc() || end != name.data() + name.size()) return {};
  return number;
}

Target target_of(const fs::path& path) {
  Target t{path, {}, {}};
  for (int links = 0; links < 40; ++links) {
    if ((t.own = own_descriptor(t.path))) return t;
    struct stat status {};
    if (::lstat(t.path.c_str(), &status) != 0) {
      if (errno == ENOENT || errno == ENOTDIR) return t;
      throw std::system_error(errno, std::generic_category());
    }
    t.there = status;
    if (!S_ISLNK(status.st_mode)) return t;
    t.there.reset();
    t.path = folder_of(t.path) / fs::read_symlink(t.path);  // an absolute one stands for itself
  }
  throw std::system_error(ELOOP, std::generic_category());
}

/// Why no file can be made in this folder, which need not exist yet; empty where one can.
std::string why_no_file_in(const fs::path& folder) {
  std::error_code ignored;
  const fs::path wanted = fs::absolute(folder, ignored);
  fs::path at = wanted;
  while (!fs::exists(at, ignored) && at.has_relative_path()) at = at.parent_path();
  if (!fs::is_directory(at, ignored)) return at.string() + " is no folder";
  if (::faccessat(AT_FDCWD, at.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return "";
  return fmt::format("no {} can be made in the folder {}: {}; name another, or allow it with chmod u+w",
                     at == wanted ? "file" : "folder", at.string(), std::strerror(errno));
}

void require_writable(const fs::path& path, const Target& t) {
  if (!path.has_filename()) refuse(path, "it is a folder, a file is wanted");
  if (!t.there && !t.own)
    if (const std::string why = why_no_file_in(folder_of(t.path)); !why.empty()) refuse(path, why);
  if (!t.there) return;
  if (S_ISDIR(t.there->st_mode)) refuse(path, "it is a folder, a file is wanted");
  if (S_ISREG(t.there->st_mode) && ((t.there->st_mode & 0222) == 0 || ::access(t.path.c_str(), W_OK) != 0))
    refuse(path, "it is read-only: make it writable with chmod u+w, or name another file");
}

void write_to_descriptor(int descriptor, const std::string& text) {
  std::fflush(nullptr);  // what was printed before stands before
  write_all(descriptor, text);
}

void write_in_place(const Target& t, const std::string& text) {
  const Opened file(t.path, O_WRONLY | (t.regular() ? O_TRUNC : 0) | O_NOCTTY);
  if (t.regular())
    write_all(file.descriptor(), text);
  else
    write_to_descriptor(file.descriptor(), text);
}

bool same_owner(const struct stat& a, const struct stat& b) { return a.st_uid == b.st_uid && a.st_gid == b.st_gid; }

/// The new file as the old one: mode, owner and group. False where it cannot be.
bool take_after(int descriptor, const struct stat& old) {
  struct stat fresh {};
  if (::fstat(descriptor, &fresh) != 0) return false;
  if (!same_owner(fresh, old) && ::fchown(descriptor, old.st_uid, old.st_gid) != 0) return false;
  return ::fchmod(descriptor, old.st_mode & 07777) == 0;
}

/// What the system said to work(): 0 where it did it.
template <class F>
int system_error_of(const F& work) {
  try {
    work();
    return 0;
  } catch (const std::system_error& e) {
    return e.code().value();
  }
}

/// False where no file can be put in the place of this one.
bool replace(const Target& t, const std::string& text) {
  if (t.there && t.there->st_nlink > 1) return false;
  bool replaced = false;
  const int reason = system_error_of([&] {
    PartFile part(t.path, "", t.there ? 0600 : 0666);
    if (t.there && !take_after(part.descriptor(), *t.there)) return;
    write_all(part.descriptor(), text);
    part.rename_to(t.path);
    replaced = true;
  });
  const bool elsewhere = reason == EACCES || reason == EPERM || reason == EROFS || reason == EBUSY;
  if (reason != 0 && !(t.there && elsewhere)) throw std::system_error(reason, std::generic_category());
  return replaced;
}

}  // namespace

std::string read_text(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw InputError(fmt::format("{}: is a folder, a file is wanted", path.string()));
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read ({})", path.string(), std::strerror(errno)));
  const bool ends = fs::is_regular_file(path, ignored);
  std::string text;
  if (ends) text.reserve(fs::file_size(path, ignored) + 1);
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0) {
    text.append(piece.data(), as_size(in.gcount()));
    if (!ends && text.size() > most_of_a_stream)
      throw InputError(fmt::format("{}: does not end: {} MB were read, and it is no regular file; name a file",
                                   path.string(), most_of_a_stream >> 20));
  }
  return text;
}

void keep_as_it_is(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) kept_as_they_are().push_back(path);
}

void require_writable_file(const fs::path& path) {
  const int reason = system_error_of([&] { require_writable(path, target_of(path)); });
  if (reason != 0) refuse(path, std::strerror(reason));
}

void require_writable_folder(const fs::path& folder) {
  if (const std::string why = why_no_file_in(folder); !why.empty()) refuse(folder, why);
}

void write_text(const fs::path& path, const std::string& text) {
  for (const fs::path& kept : kept_as_they_are())
    if (std::error_code error; fs::equivalent(path, kept, error) && !error)
      refuse(path, "this is an input file: name another");
  const int reason = system_error_of([&] {
    const Target t = target_of(path);
    require_writable(path, t);
    if (t.own) return write_to_descriptor(*t.own, text);
    std::error_code ignored;  // a folder that is missing is told where the file is opened
    if (!t.there) fs::create_directories(folder_of(t.path), ignored);
    if (!t.regular() || !replace(t, text)) write_in_place(t, text);
  });
  if (reason != 0) refuse(path, std::strerror(reason));
}

std::string text_written_by(const fs::path& path, const std::string& suffix,
                            const std::function<void(const fs::path&)>& write) {
  std::string text;
  const int reason = system_error_of([&] {
    const Target t = target_of(path);
    require_writable(path, t);
    std::error_code ignored;
    if (!t.there && !t.own) fs::create_directories(folder_of(t.path), ignored);
    const bool beside = t.regular() && ::access(folder_of(t.path).c_str(), W_OK) == 0;
    const PartFile part(beside ? t.path : fs::temp_directory_path() / ("deflect-" + t.path.filename().string()),
                        suffix);
    write(part.path());
    text = read_text(part.path());
  });
  if (reason != 0) refuse(path, std::strerror(reason));
  return text;
}

std::string safe_file_name(std::string_view name) {
  std::string out(name.substr(0, 200));
  while (out.size() < name.size() && !out.empty() && (static_cast<unsigned char>(name[out.size()]) & 0xC0) == 0x80)
    out.pop_back();  // not inside a letter
  const auto kept = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || c == '-' || c == '_' || c == '.' || c == ' ';
  };
  std::replace_if(
      out.begin(), out.end(), [&](char c) { return !kept(static_cast<unsigned char>(c)); }, '_');
  if (out.empty()) return "_";
  if (out.front() == '.') out.front() = '_';
  return out;
}

}  // namespace deflect
