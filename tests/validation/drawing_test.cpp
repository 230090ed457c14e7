// The picture of a machine as its file draws it.
#include "validation/figures/drawing.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/devices.h"
#include "validation/figures/drawing_results.h"

namespace deflect {
namespace {

using namespace figures;

/// The rows of a gnuplot data block, four numbers each.
std::vector<std::array<double, 4>> rows(const std::string& body, const std::string& block) {
  const std::size_t from = body.find("$" + block + " << EOD\n");
  if (from == body.npos) return {};
  std::istringstream in(body.substr(from + block.size() + 9, body.find("EOD", from + block.size() + 9) - from));
  std::vector<std::array<double, 4>> out;
  for (std::array<double, 4> row; in >> row[0] >> row[1] >> row[2] >> row[3];) out.push_back(row);
  return out;
}

TEST(DrawingFigure, ArrowsOfBaseAndToolLieWithinTheSmallViews) {
  for (const char* device : {"haptic-6psu", "delta", "stewart-6ups", "scara", "gantry", "3-rrr", "arm"}) {
    const Figure f = drawing_figure(drawing_of(test::device(device)), {});
    const double wide = 0.44 * f.width_mm, tall = 0.42 * f.width_mm;
    for (const char* view : {"1", "2"})
      for (const char* axis : {"0", "1", "2"}) {
        const auto arrows = rows(f.body, std::string("frame") + axis + "_" + view);
        EXPECT_EQ(arrows.size(), 2u) << device;  // base and tool
        for (const auto& [x, y, dx, dy] : arrows) {
          EXPECT_GE(std::min(x, x + dx), 0) << device << " view " << view;
          EXPECT_LE(std::max(x, x + dx), wide) << device << " view " << view;
          EXPECT_GE(std::min(y, y + dy), 0) << device << " view " << view;
          EXPECT_LE(std::max(y, y + dy), tall) << device << " view " << view;
        }
      }
  }
}

}  // namespace
}  // namespace deflect
