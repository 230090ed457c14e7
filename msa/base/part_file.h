// A temporary file in the folder of the file to be written: "NAME.part" plus the process id.
//
// It is locked (flock) as long as the object exists. A killed run leaves its part file without a lock; the next run
// that writes NAME removes it, unless a process with that id is alive.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace deflect {

class PartFile {
 public:
  /// Creates an empty file with that mode (less the umask) in the folder of `target`. Its name ends with `suffix`.
  /// Throws std::system_error.
  explicit PartFile(const std::filesystem::path& target, const std::string& suffix = "", mode_t mode = 0666);
  ~PartFile();  ///< removes it, unless it was renamed
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }

  /// Throws std::system_error.
  void rename_to(const std::filesystem::path&);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace deflect
