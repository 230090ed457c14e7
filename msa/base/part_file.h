// A new file beside the one that is to be written in the end: "NAME.part" and the number of the process.
//
// It holds a lock (flock) as long as the object lives. A run that was killed leaves its part file without one: the next
// run that writes NAME removes it, unless a process of that number is alive.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace deflect {

class PartFile {
 public:
  /// An empty file of that mode, less what the umask takes, in the folder of `target`. `suffix` stands at the end of
  /// its name. Throws std::system_error.
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
