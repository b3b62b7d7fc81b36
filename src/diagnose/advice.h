// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Explanations of effects for technicians: what each is, how to check on the rig whether it is present, and
// how to cure it.
#include <span>
#include <string_view>

namespace fidservo::diagnose {

struct Advice {
    std::string_view effect;  ///< its name in the catalogue
    std::string_view what;    ///< a clause that can follow "because" and stand in a headline
    std::string_view check;   ///< how to check it on the rig, in sentences
    std::string_view cure;    ///< how to cure it, in sentences
};

/// One for every effect of the catalogue.
std::span<const Advice> all_advice();

/// The advice on an effect of the catalogue; nullptr for other names.
const Advice* advice_on(std::string_view effect);

/// Possible causes of a remainder that depends on a quantity, and where to look first.
/// @param dependence  as gap::Remainder names it: "velocity", "position, periodic (2.5 mm)" Empty for other
/// names.
std::string_view advice_on_dependence(std::string_view dependence);

}  // namespace fidservo::diagnose
