#include "validation/cli/new_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "validation/cli/devices.h"

namespace deflect::cli {
namespace {

void require_whole(const std::string& text, const std::string& out, bool is_frame) {
  if (is_frame) {
    frame::parse_frame(text, out);
    return;
  }
  const Mechanism written = parse_mechanism(text, out);
  configure(written, home_pose(written));
}

}  // namespace

void write_description(const subject::Subject& changed, const std::string& before, const std::string& done,
                       const std::vector<std::string>& items, const std::string& out) {
  const std::string line = changed.about();
  const std::string about = fmt::format("{}{}{} {}", line, line.empty() ? "" : "; ", done, fmt::join(items, ", "));
  const std::string text = fmt::format("# {} {}\n#   {}\n{}", before, done, fmt::join(items, "\n#   "),
                                       changed.file_text(std::filesystem::path(out).stem().string(), about));
  require_whole(text, out, changed.frame());
  write_file(out, text);
}

}  // namespace deflect::cli
