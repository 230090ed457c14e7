// The seeds of the fuzzing and what it has found, through the same entry points (targets.h).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

#include "msa/base/files.h"
#include "msa/base/index.h"
#include "tests/attack/count.h"
#include "tests/fuzz/targets.h"

namespace deflect::fuzz {
namespace {

TEST(FuzzedReaders, TakeTheSeedsAndWhatWasOnceFound) {
  for (const Target& t : targets()) {
    EXPECT_FALSE(seed_files(t).empty()) << t.name;
    for (const std::filesystem::path& file : seed_files(t))
      EXPECT_NO_THROW(t.run(read_text(file))) << t.name << " " << file;
  }
}

// Cut short at every 97th byte, with a byte changed there: files as they come out of a broken copy.
TEST(FuzzedReaders, TakeBrokenSeeds) {
  for (const Target& t : targets())
    for (const std::filesystem::path& file : seed_files(t)) {
      const std::string text = read_text(file);
      for (std::size_t at = 1; at < text.size() && at < 97 * 20; at += 97) {
        EXPECT_NO_THROW(t.run(text.substr(0, at))) << t.name << " " << file << " cut at " << at;
        std::string changed = text;
        changed[at] = static_cast<char>(changed[at] ^ 0x15);
        EXPECT_NO_THROW(t.run(changed)) << t.name << " " << file << " changed at " << at;
      }
    }
}

using Generator = std::mt19937_64;
std::size_t below(Generator& g, std::size_t n) { return as_size(g() % n); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    out.back() += c;
    if (c == '\n') out.emplace_back();
  }
  return out;
}

/// Words, numbers and what stands between them.
std::vector<std::string> tokens_of(const std::string& text) {
  std::vector<std::string> out;
  const auto kind = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' ? 1 : 0; };
  for (const char c : text)
    if (!out.empty() && kind(c) == 1 && kind(out.back().back()) == 1)
      out.back() += c;
    else
      out.emplace_back(1, c);
  return out;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& p : parts) out += p;
  return out;
}

/// One to four small changes: bytes, words of one's own and of others, lines.
std::string changed(std::string text, const std::string& other, Generator& g) {
  static const std::vector<std::string> hostile = {
      "0",  "-1", "1e308", "-1e-320", "nan",  "inf", "1e400", "18446744073709551616",
      "\"", "[",  "]",     "{",       "}",    ":",   ",",     "\n",
      "\t", " ",  "null",  "~",       "*",    "&a ", "*a ",   "!!",
      "#",  "-",  "|",     "µ",       "\xff", ""};
  for (std::size_t left = 1 + below(g, 4); left > 0 && !text.empty(); --left) {
    std::vector<std::string> parts = below(g, 2) ? tokens_of(text) : lines_of(text);
    const std::vector<std::string> others = parts.size() % 2 ? tokens_of(other) : lines_of(other);
    std::string& one = parts[below(g, parts.size())];
    switch (below(g, 7)) {
      case 0:
        one = hostile[below(g, hostile.size())];
        break;
      case 1:
        one += one;
        break;
      case 2:
        std::swap(one, parts[below(g, parts.size())]);
        break;
      case 3:
        if (!others.empty()) one = others[below(g, others.size())];
        break;
      case 4:
        one.clear();
        break;
      case 5:
        one.insert(below(g, one.size() + 1), hostile[below(g, hostile.size())]);
        break;
      default:
        if (!one.empty()) one[below(g, one.size())] = static_cast<char>(g());
    }
    text = joined(parts);
  }
  return text;
}

/// Without sanitizers and without a look at what is reached, but in the tests' own program: the first that fails of
/// each target is kept in the folder attack/. DEFLECT_FUZZ=frame: that target alone.
TEST(FuzzedReadersOnDemand, TakeChangedSeeds) {
  if (attack::count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of texts for each reader";
  const char* only = std::getenv("DEFLECT_FUZZ");
  for (const Target& t : targets()) {
    if (only && t.name != only) continue;
    Generator g(attack::first_on_demand() + 1);
    const std::vector<std::filesystem::path> files = seed_files(t);
    std::vector<std::string> seeds;
    for (const std::filesystem::path& file : files) seeds.push_back(read_text(file));
    unsigned failures = 0;
    for (unsigned i = 0; i < attack::count_on_demand(); ++i) {
      const std::string text = changed(seeds[below(g, seeds.size())], seeds[below(g, seeds.size())], g);
      std::ofstream(attack::failures_folder() / (t.name + "-last")) << text;  // it may be the last
      try {
        t.run(text);
      } catch (const std::exception& e) {
        const std::filesystem::path kept = attack::failures_folder() / fmt::format("{}-{}", t.name, i);
        if (failures++ < 20) write_text(kept, text);
        if (failures < 20) ADD_FAILURE() << kept << ": " << std::string(e.what()).substr(0, 2000);
      }
    }
    fmt::print("{:<12} {} texts, {} failures\n", t.name, attack::count_on_demand(), failures);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace deflect::fuzz
