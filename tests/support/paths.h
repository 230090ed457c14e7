// Where the tests find the source and the program. Only paths.cpp is compiled with these two paths; all other files of
// tests are compiled alike wherever the checkout lies, so that a compiler cache serves each of them.
#pragma once

#include <string>

namespace deflect::test {

/// The root of the source, absolute, without a slash at the end.
std::string source_dir();

/// The program under test, absolute.
std::string program();

}  // namespace deflect::test
