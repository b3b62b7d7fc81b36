// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Diagnoses that leave something open, for tests of the experiments that decide.
#include "gap/diagnosis.h"
#include "plant/effects/catalogue.h"

#include <string>

namespace fidservo::testing {

/// One effect found, tied with another.
inline gap::Diagnosis tied(const std::string& found, const std::string& rival) {
    gap::Diagnosis diagnosis;
    diagnosis.hypothesis = {plant::parse_effect(found)};
    gap::FoundEffect effect{};
    effect.effect = diagnosis.hypothesis.front().effect->name;
    effect.rivals = {plant::parse_effect(rival)};
    diagnosis.effects = {effect};
    return diagnosis;
}

}  // namespace fidservo::testing
