// Frames in tests: the files of published cases, and results by name.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/paths.h"

namespace deflect::test {

inline constexpr double inch = 0.0254, lbf = 4.4482216152605, kip = 1e3 * lbf;

inline frame::FrameDescription case_file(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/cases" / (name + ".yaml"));
}

/// A frame with its result, to be asked by name; the first case where none is named.
struct Solved {
  explicit Solved(frame::FrameDescription f, const frame::FrameOptions& options = {})
      : frame(std::move(f)), result(frame::analyse(frame, options)) {}

  template <class T>
  static std::size_t at(const Named<T>& list, const std::string& name) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].first == name) return i;
    throw std::out_of_range(name);
  }
  const Vector6& u(const std::string& node, std::size_t c = 0) const {
    return result.cases[c].displacements[at(frame.nodes, node)];
  }
  const Vector6& reaction(const std::string& node, std::size_t c = 0) const {
    return result.cases[c].reactions[at(frame.supports, node)];
  }
  const frame::MemberForces& member(const std::string& name, std::size_t c = 0) const {
    return result.cases[c].members[at(frame.members, name)];
  }

  frame::FrameDescription frame;
  frame::FrameResult result;
};

}  // namespace deflect::test
