// Result files as they are read back: validation/result_files, and what `add --from` takes of a diagnosis.
#include "tests/fuzz/reader.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/result_files/provenance.h"
#include "validation/result_files/result_file.h"

namespace {

template <class F>
void refused_at_most(const F& read) {
  try {
    read();
  } catch (const deflect::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  const std::string text(reinterpret_cast<const char*>(data), size);
  refused_at_most([&] { result_files::read_result(text, "file"); });
  refused_at_most([&] { diagnosis::parse_found_effects(text, "file"); });
  refused_at_most([&] {
    const Json json = json::parse_json(text, "file", "give a result");
    if (!result_files::differences(json, json, 0, 10).empty()) std::abort();
    result_files::read_provenance(json, "file");
  });
  return 0;
}
