// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Charts of the errors against what they depend on.
#include "src/diagnose/report/dependence.h"

#include <string>

namespace fidservo::diagnose {

/// Of every signal that is off its floor: binned mean errors before and after with bands of two standard
/// errors, and the floor. What a remainder depends on is marked.
std::string dependence_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                            const Predictions& predictions);

}  // namespace fidservo::diagnose
