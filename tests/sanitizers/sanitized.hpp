#pragma once

#include <gtest/gtest.h>

#include <concepts>

namespace oval4d {

/// Whether this is a build with a sanitizer, in which everything takes 3 to 20 times as long.
#ifdef OVAL4D_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Returns the number of trials of a test with random input: all, or a tenth of them with a sanitizer.
template <std::integral Count>
constexpr Count trials(Count count) {
    return kSanitized ? count / 10 : count;
}

}  // namespace oval4d

/// Skips the current test in builds with a sanitizer: it computes for long, and other tests run the same code.
#define SKIP_IF_SANITIZED() \
    if (kSanitized) GTEST_SKIP() << "computes for too long with a sanitizer"
