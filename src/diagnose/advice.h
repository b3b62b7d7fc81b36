// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an effect is in words of the workshop, how to check on the rig that it is there, and how to cure it.
#include <span>
#include <string_view>

namespace fidservo::diagnose {

struct Advice {
    std::string_view effect;  ///< its name in the catalogue
    std::string_view what;    ///< a clause that can follow "because" and stand in a headline
    std::string_view check;   ///< on the rig, in sentences
    std::string_view cure;    ///< likewise
};

/// One for every effect of the catalogue.
std::span<const Advice> all_advice();

/// Of an effect of the catalogue; nullptr for other names.
const Advice* advice_on(std::string_view effect);

/// What can be behind a remainder that depends on something, and where to look first.
/// @param dependence  as gap::Remainder names it: "velocity", "position, periodic (2.5 mm)"
/// Empty for other names.
std::string_view advice_on_dependence(std::string_view dependence);

}  // namespace fidservo::diagnose
