// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rigs with many causes. Drawing one takes half a minute, so it is done once for all tests of a process.
#include "src/selfcheck/draw/crowded_draw.h"
#include "tests/reference_rig.h"

#include <cstddef>
#include <cstdint>
#include <map>

#include <gtest/gtest.h>

namespace fidservo::testing {

inline constexpr std::uint64_t messy_seed = 3;

/// The first crowded case of a kind, for the seed `messy_seed`.
inline const selfcheck::Case& first_crowded_case(selfcheck::CaseKind kind) {
    static std::map<selfcheck::CaseKind, selfcheck::Case> drawn;
    if (const auto found = drawn.find(kind); found != drawn.end()) return found->second;
    std::size_t number = 0;
    while (selfcheck::kind_of_crowded_case(messy_seed, number) != kind) ++number;
    return drawn.emplace(kind, selfcheck::draw_crowded_case(reference_rig(), messy_seed, number))
        .first->second;
}

/// The same effects, of the same formulas and sizes.
inline void expect_same_label(const selfcheck::Label& a, const selfcheck::Label& b) {
    ASSERT_EQ(a.effects.size(), b.effects.size());
    for (std::size_t k = 0; k < a.effects.size(); ++k) {
        EXPECT_EQ(a.effects[k].effect, b.effects[k].effect);
        EXPECT_EQ(a.effects[k].formula, b.effects[k].formula);
        EXPECT_EQ(a.effects[k].size, b.effects[k].size);
    }
}

}  // namespace fidservo::testing
