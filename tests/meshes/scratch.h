// What the tests of the exporters share: a folder of their own, a small mesh, and a disk that is full.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>

#include "meshes/line_mesh.h"
#include "msa/base/files.h"

namespace deflect {

/// A folder that exists as long as the object.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "deflect-meshes-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

 private:
  std::filesystem::path folder_;
};

/// No file grows beyond `bytes` while the object lives. Unlike missing permissions, this stops the superuser too.
class FullDisk {
 public:
  explicit FullDisk(std::size_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

/// Two groups that share a point, a group without cells, and a point (the fourth) that no cell uses.
inline LineMesh small_mesh() {
  return {{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0.05, 0.3}, {9, 9, 9}, {0.2, 0.1, 1.0 / 3}},
          {{0, 1, 0}, {1, 2, 2}, {4, 2, 0}},
          {"leg 1 guideway", "spare", "platform"}};
}

inline FieldData small_fields() {
  return {{{"displacement_mm", {{1, 2, 3}, {0.1, 0.2, 0.25}, {-4, 5, 6}, {7, 8, 9}, {1e-300, 0, 1e300}}},
           {"rotation_rad", std::vector<Vector3>(5, Vector3(0, 0, 1e-3))}},
          {{"axial_force_N", {1.5, -2, 0.1}}}};
}

/// `write(path, mesh, fields)` fails as `Error` and leaves the old file and nothing else, wherever the disk ends and
/// where a neighbour of the file cannot be made; what it cannot replace stays.
template <typename Error, typename Write>
void expect_old_file_survives(Write write) {
  const Scratch scratch;
  write(scratch / "whole", small_mesh(), small_fields());
  const std::size_t size = read_text(scratch / "whole").size();
  ASSERT_GT(size, 500u);

  const std::filesystem::path path = scratch / "old";
  write_text(path, "old");
  for (std::size_t room = 0; room < size; room += 7) {
    const FullDisk full(room);
    EXPECT_THROW(write(path, small_mesh(), small_fields()), Error) << room;
  }
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(scratch.files(), 2);

  const std::filesystem::path longest = scratch / std::string(255, 'n');
  std::filesystem::rename(path, longest);
  EXPECT_THROW(write(longest, small_mesh(), small_fields()), Error);
  EXPECT_EQ(read_text(longest), "old");

  EXPECT_THROW(write(longest / "below", small_mesh(), small_fields()), Error);
  std::filesystem::create_directory(scratch / "folder");
  EXPECT_THROW(write(scratch / "folder", small_mesh(), small_fields()), Error);
  EXPECT_EQ(scratch.files(), 3);

  write(longest.parent_path() / "new folder" / "new", small_mesh(), small_fields());
  EXPECT_EQ(read_text(scratch / "new folder/new").size(), size);
}

}  // namespace deflect
