// Whether the tests are built with the address sanitizer (preset debug), and how much longer things take then.
#pragma once

#if defined(__has_feature)  // clang++ has no macro for it
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif

namespace deflect::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr int times_slower = 30;
#else
inline constexpr int times_slower = 1;
#endif

}  // namespace deflect::test
