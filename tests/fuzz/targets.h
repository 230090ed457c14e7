// Every reader of the program as a function of a text, for inputs that nobody wrote: by libFuzzer under sanitizers
// (libfuzzer/entry.cpp), and in the tests, which run the seeds and what was once found.
//
// A reader may refuse a text with an InputError or a ModelError. What it reads, it must write so that it reads back as
// the same. Anything else is a fault: another exception, std::logic_error where what was written does not read back, a
// memory error, undefined behaviour, a run without an end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace deflect::fuzz {

struct Target {
  std::string name;
  void (*run)(const std::string& text);
  std::vector<std::filesystem::path> seeds;  ///< folders and files of the tree with texts to begin with
};

/// device, frame, effect, measurement, matrix, result, and edits: of devices and a frame, by lines with a path and a
/// value by turns (the first byte of the text chooses what is edited, the first of a path the action).
const std::vector<Target>& targets();

/// The files that a target's seeds stand for.
std::vector<std::filesystem::path> seed_files(const Target&);

}  // namespace deflect::fuzz
