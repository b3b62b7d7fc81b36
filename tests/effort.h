// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/sanitizer.h"

#include <cstdlib>
#include <string_view>

namespace fidservo::testing {

/// How many cases a test draws. A sanitizer slows every one of them five to ten times, and what it looks for
/// shows in the first ones.
constexpr int cases(int all, int under_sanitizer) {
    return has_sanitizer ? under_sanitizer : all;
}

/// Whether the environment has FIDSERVO_DRAWS=all (./run test --all-draws).
inline bool has_all_draws() {
    const char* const asked = std::getenv("FIDSERVO_DRAWS");
    return asked != nullptr && std::string_view(asked) == "all";
}

/// The number of random draws of a test: usually `guard`, the few that protect against regressions; `all`, on
/// which the documentation's figures are based, where the environment has FIDSERVO_DRAWS=all (./run test
/// --all-draws). The few are the first ones of all.
inline int draws(int all, int guard) {
    return has_all_draws() ? all : guard;
}

}  // namespace fidservo::testing
