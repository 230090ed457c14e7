// Numbers in sentences.
#include "msa/base/number_words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace deflect {
namespace {

TEST(NumberWords, DigitsWithoutExponentWhereAPersonReadsThem) {
  EXPECT_EQ(digits_of(200000, 2), "200000");
  EXPECT_EQ(digits_of(123456, 4), "123500");
  EXPECT_EQ(digits_of(0.0031234, 3), "0.00312");
  EXPECT_EQ(digits_of(9.996, 3), "10.0");
  EXPECT_EQ(digits_of(0, 3), "0.00");
  EXPECT_EQ(digits_of(-1.25e12, 3), "-1.25e+12");
  EXPECT_EQ(digits_of(3.2e-7, 2), "3.2e-07");
}

TEST(NumberWords, AnIntervalHasTheDigitsThatTellItsBoundsApart) {
  EXPECT_EQ(interval_words(2e5, 199'950, 200'050), "200000 (199950 … 200050)");
  EXPECT_EQ(interval_words(5e6, 4.9e6, 5.1e6), "5000000 (4900000 … 5100000)");
  EXPECT_EQ(interval_words(1.23456789, 1.23456, 1.23458), "1.234568 (1.234560 … 1.234580)");
  EXPECT_EQ(interval_words(1e8, 1e7, 1e8), "1e+08 (1e+07 … 1e+08)");
  EXPECT_EQ(interval_words(0.6124, 0.6051, INFINITY), "0.6124 (at least 0.6051)");
  for (const double width : {1e-1, 1e-3, 1e-5, 1e-8}) {
    const std::string text = interval_words(2e5, 2e5 * (1 - width), 2e5 * (1 + width));
    const std::string low = text.substr(text.find('(') + 1, text.find(" …") - text.find('(') - 1);
    const std::string high = text.substr(text.find("… ") + 4, text.find(')') - text.find("… ") - 4);
    EXPECT_NE(low, high) << text;
  }
}

TEST(NumberWords, AValueGoesToTheLastDigitOfItsDeviation) {
  EXPECT_EQ(plus_minus_words(123.4567, 0.0123), "123.457 ± 0.012");
  EXPECT_EQ(plus_minus_words(1.5, 30), "1.50 ± 30");
  EXPECT_EQ(plus_minus_words(-0.02, 0.0004), "-0.02000 ± 0.00040");
}

TEST(NumberWords, AFallShowsThatItFalls) {
  EXPECT_EQ(fall_words(1.2143, 1.2131), "1.214 to 1.213");
  EXPECT_EQ(fall_words(71, 1.02), "71 to 1.0");
}

}  // namespace
}  // namespace deflect
