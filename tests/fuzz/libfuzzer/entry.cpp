// libFuzzer's entry: DEFLECT_FUZZ names the target. With DEFLECT_FUZZ_SEEDS=FOLDER the seeds of all targets are copied
// into FOLDER/<target>/ at the start.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/fuzz/targets.h"

namespace {

const deflect::fuzz::Target* chosen = nullptr;

void copy_seeds(const std::filesystem::path& folder) {
  for (const deflect::fuzz::Target& t : deflect::fuzz::targets()) {
    std::filesystem::create_directories(folder / t.name);
    for (const std::filesystem::path& file : seed_files(t))
      copy_file(file, folder / t.name / file.filename(), std::filesystem::copy_options::skip_existing);
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (const char* folder = std::getenv("DEFLECT_FUZZ_SEEDS")) copy_seeds(folder);
  const char* name = std::getenv("DEFLECT_FUZZ");
  for (const deflect::fuzz::Target& t : deflect::fuzz::targets())
    if (name && t.name == name) chosen = &t;
  if (chosen) return 0;
  std::fprintf(stderr, "DEFLECT_FUZZ must name a target:");
  for (const deflect::fuzz::Target& t : deflect::fuzz::targets()) std::fprintf(stderr, " %s", t.name.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
