// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo::testing {

/// How many cases a test draws. A sanitizer slows every one of them five to ten times, and what it looks for
/// shows in the first ones.
constexpr int cases([[maybe_unused]] int all, [[maybe_unused]] int under_sanitizer) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return under_sanitizer;
#else
    return all;
#endif
}

}  // namespace fidservo::testing
