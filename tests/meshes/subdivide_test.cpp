#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include "meshes/gmsh.h"
#include "meshes/gmsh_module.h"
#include "msa/base/error.h"
#include "tests/meshes/scratch.h"

namespace deflect::gmsh {
namespace {

using Positions = std::vector<std::vector<double>>;

void expect_uniform(const std::vector<double>& positions, std::size_t elements) {
  ASSERT_EQ(positions.size(), elements + 1);
  EXPECT_EQ(positions.front(), 0);
  EXPECT_EQ(positions.back(), 1);
  for (std::size_t i = 0; i <= elements; ++i)
    EXPECT_NEAR(positions[i], static_cast<double>(i) / static_cast<double>(elements), 1e-10);
}

std::string input_error(const std::vector<double>& lengths, double size) {
  try {
    subdivide(lengths, size);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Subdivide, EqualElementsAboutAsLongAsAsked) {
  expect_uniform(subdivide({1}, 0.1)[0], 10);
  expect_uniform(subdivide({0.3}, 0.1)[0], 3);  // 0.3 / 0.1 < 3
  expect_uniform(subdivide({1}, 0.3)[0], 4);
  expect_uniform(subdivide({0.25}, 0.01)[0], 25);
  expect_uniform(subdivide({1}, 1)[0], 1);
  expect_uniform(subdivide({1}, 0.995)[0], 1);  // 1 % more than asked, no element of nearly no length
  expect_uniform(subdivide({1}, 0.98)[0], 2);
  expect_uniform(subdivide({1}, 7)[0], 1);
  expect_uniform(subdivide({1}, 1e300)[0], 1);
}

TEST(Subdivide, AnyScale) {
  for (const double scale : {1e-12, 1e-3, 1e9, 1e300}) expect_uniform(subdivide({scale}, scale / 8)[0], 8);
  EXPECT_EQ(subdivide({1}, 1e-6)[0].size(), 1000001u) << "the most that is allowed";
}

TEST(Subdivide, MembersDoNotDependOnEachOther) {
  std::vector<double> lengths;
  for (int i = 0; i < 500; ++i) lengths.push_back(0.001 + 0.01 * i);
  lengths.insert(lengths.end(), {1e-9, 1e3, 0.25, 0.25});
  const Positions together = subdivide(lengths, 0.02);
  ASSERT_EQ(together.size(), lengths.size());
  for (const std::size_t i : {0u, 13u, 499u, 500u, 501u, 502u, 503u}) {
    const auto elements = static_cast<std::size_t>(std::max(1.0, std::floor(lengths[i] / 0.02 + 0.99)));
    expect_uniform(together[i], elements);
    EXPECT_EQ(together[i], subdivide({lengths[i]}, 0.02)[0]);
  }
  EXPECT_EQ(subdivide({}, 0.02), Positions());
}

TEST(Subdivide, SameBitsEveryTimeAndFromEveryThread) {
  const std::vector<double> lengths = {0.125, 0.3, 1.0 / 3, 2};
  const Positions first = subdivide(lengths, 0.007);
  EXPECT_EQ(subdivide(lengths, 0.007), first);
  std::vector<Positions> found(4);
  std::vector<std::thread> threads;
  for (Positions& result : found) threads.emplace_back([&] { result = subdivide(lengths, 0.007); });
  for (std::thread& thread : threads) thread.join();
  for (const Positions& result : found) EXPECT_EQ(result, first);
}

TEST(Subdivide, RefusesSizesAndLengthsNamingThem) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, 0.0, -0.1, inf, -inf}) {
    EXPECT_NE(input_error({1}, bad).find("element size"), std::string::npos) << bad;
    EXPECT_NE(input_error({1, bad}, 0.1).find("member 2 has length"), std::string::npos) << bad;
  }
  const std::string many = input_error({1e-9, 1}, 0.99e-6);
  EXPECT_NE(many.find("1000000 elements in member 2"), std::string::npos) << many;
  EXPECT_NE(input_error({1e300}, 1e-300), "");
}

TEST(Subdivide, WorksAfterFailures) {
  const Positions before = subdivide({1}, 0.1);
  EXPECT_THROW(subdivide({1}, 0), InputError);
  EXPECT_EQ(subdivide({1}, 0.1), before);

  // Past the checks, into Gmsh itself.
  const auto& module = static_cast<const Module&>(load_module(module_kind));
  const Scratch scratch;
  EXPECT_NE(module.write_msh(scratch / "no such folder/a.msh", small_mesh(), {}), "");
  EXPECT_EQ(subdivide({1}, 0.1), before);
  Positions ignored;
  module.subdivide({1, 0}, ignored);  // fails without a word
  EXPECT_EQ(subdivide({1}, 0.1), before);
}

TEST(Subdivide, LeavesTheProcessAsItWas) {
  const std::string locale = std::setlocale(LC_ALL, nullptr);
  subdivide({1}, 0.1);  // now OpenMP is loaded
  const auto get = reinterpret_cast<int (*)()>(::dlsym(RTLD_DEFAULT, "omp_get_max_threads"));
  const auto set = reinterpret_cast<void (*)(int)>(::dlsym(RTLD_DEFAULT, "omp_set_num_threads"));
  const int threads = get != nullptr ? get() : 0;
  if (set != nullptr) set(3);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  subdivide({1}, 1e-5);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), locale);
  if (get != nullptr && set != nullptr) {
    EXPECT_EQ(get(), 3);
    set(threads);
  }
}

TEST(GmshModule, IsNotFoundClearly) {
  const Scratch scratch;
  write_text(scratch / "broken/deflect_gmsh.so", "no library");
  try {
    load_module(module_kind, {scratch / "empty", scratch / "broken"});
    FAIL() << "loaded";
  } catch (const ModelError& error) {
    const std::string text = error.what();
    for (const std::string& part : {(scratch / "empty/deflect_gmsh.so").string() + ": no such file",
                                    (scratch / "broken/deflect_gmsh.so: ").string(), std::string("DEFLECT_PLUGIN_DIR")})
      EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
  }
}

TEST(GmshModule, TheEnvironmentComesFirst) {
  const char* const set = std::getenv("DEFLECT_PLUGIN_DIR");
  const std::string before = set != nullptr ? set : "";
  ::setenv("DEFLECT_PLUGIN_DIR", "/chosen", 1);
  EXPECT_EQ(module_folders().at(0), "/chosen");
  ::setenv("DEFLECT_PLUGIN_DIR", "", 1);
  EXPECT_EQ(module_folders().at(0), std::filesystem::read_symlink("/proc/self/exe").parent_path());
  for (const std::filesystem::path& folder : module_folders()) EXPECT_TRUE(folder.is_absolute()) << folder;
  ::setenv("DEFLECT_PLUGIN_DIR", before.c_str(), 1);
}

}  // namespace
}  // namespace deflect::gmsh
