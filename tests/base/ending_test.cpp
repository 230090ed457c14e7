// Errors as exit code and message, and back.
#include "msa/base/ending.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>

#include "msa/base/error.h"

namespace deflect {
namespace {

template <class Error>
Ending of(const Error& error) {
  return ending_of(std::make_exception_ptr(error));
}

TEST(Ending, HasTheCodeOfTheKind) {
  EXPECT_EQ(of(InputError("a")).code, 2);
  EXPECT_EQ(of(ModelError("a")).code, 3);
  EXPECT_EQ(of(NumericalError("a")).code, 4);
  EXPECT_EQ(of(std::bad_alloc()).code, 4);
  EXPECT_EQ(of(std::logic_error("a")).code, 70);
  EXPECT_EQ(of(1).code, 70);
  const Ending refused =
      of(std::filesystem::filesystem_error("status", "a/b", {ENAMETOOLONG, std::generic_category()}));
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.message, "a/b: File name too long");
  EXPECT_EQ(of(std::bad_alloc()).message, "out of memory");
}

TEST(Ending, IsThrownAsWhatItWas) {
  for (const int code : {2, 3, 4, 70}) try {
      throw_ending({code, "what happened"});
    } catch (...) {
      const Ending e = ending_of(std::current_exception());
      EXPECT_EQ(e.code, code);
      EXPECT_EQ(e.message, "what happened");
    }
}

}  // namespace
}  // namespace deflect
