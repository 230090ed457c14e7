// What a result was made from: the member "provenance" of every result file.
//
//   "provenance": {
//     "program": "deflect 0.1.0",
//     "command": ["diagnose", "haptic-6psu-ideal-joints", "hidden.csv", "--bootstrap=1999"],
//     "inputs": [{"name": "hidden.csv", "sha256": "…"}, …],
//     "outputs": [{"name": "softer.yaml", "sha256": "…"}],
//     "seed": 7,
//     "machine": {"system": "Linux x86_64", "processor": "…", "compiler": "g++ 12.2.0"}
//   }
//
// The command has every number that was in force, given or not. What does not change the result is left out of it:
// where the result is written, threads, what is printed. So the same inputs give the same bytes on the same machine.
// Inputs are the files that the command line names, built-in ones by their name, and "effects/catalogue", all files of
// the catalogue one after the other. Outputs are files that the command must be told. The seed is there where the
// command has one; the others draw no random numbers, or from a fixed seed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "validation/json/json_text.h"

namespace deflect::result_files {

struct HashedFile {
  std::string name;    ///< as on the command line
  std::string sha256;  ///< empty for what is no regular file
  bool operator==(const HashedFile&) const = default;
};

struct Provenance {
  std::string program;
  std::vector<std::string> command;
  std::vector<HashedFile> inputs, outputs;
  std::optional<std::uint64_t> seed;
  std::string system, processor, compiler;
};

Json provenance_json(const Provenance&);

/// The result with the provenance as its last member. `result`: text of a JSON object as json_text() writes it.
std::string with_provenance(const std::string& result, const Provenance&);

/// InputError where the result has none, or one that is not as above.
Provenance read_provenance(const Json& result, const std::string& origin);

/// Of this machine and build: system, processor, compiler.
void describe_machine(Provenance&);

/// In which members two results differ, "candidates[0].probability: 0.9 instead of 0.8", at most `most` of them.
/// Numbers are equal within `tolerance` of the larger of the two, or within what rounding leaves of the largest number
/// of the same list (1e-13 of it); all else must be the same. The provenance is not compared.
std::vector<std::string> differences(const Json& before, const Json& now, double tolerance, std::size_t most);

}  // namespace deflect::result_files
