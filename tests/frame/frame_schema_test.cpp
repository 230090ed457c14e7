// The schema of frame files is what the reader reads.
#include "msa/frame/file/frame_schema.h"

#include "msa/frame/file/frame_file.h"
#include "tests/support/schema_routes.h"

namespace deflect::frame {
namespace {

TEST(FrameSchema, KnowsTheKeysThatTheReaderKnowsAndNoOthers) {
  const std::map<std::string, std::string> prefix = {
      {"materials", "{NAME: {E: 1 GPa, nu: 0.3, density: 1 kg/m^3, expansion: 1e-5 1/K}}"},
      {"sections", "{NAME: {shape: round, diameter: 1 mm}}"},
      {"nodes", "{NAME: [0 mm, 0 mm, 0 mm], OTHER: [1 m, 0 mm, 0 mm]}"},
      {"members", "{NAME: {from: NAME, to: OTHER, section: NAME, material: NAME}}"},
      {"supports", "{NAME: clamped}"}};
  test::SchemaRoutes routes(frame_schema(), prefix, [](const std::string& document) { parse_frame(document, "file"); });
  EXPECT_GE(routes.compared(), 60);
}

}  // namespace
}  // namespace deflect::frame
