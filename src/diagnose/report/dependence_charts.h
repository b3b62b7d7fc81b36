// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Charts of the errors over the quantities on which they depend.
#include "src/diagnose/report/dependence.h"

#include <string>

namespace fidservo::diagnose {

/// For every signal above its floor: binned mean errors without and with the explanation, with bands of two
/// standard errors, and the floor. The quantity on which a remainder depends is marked.
std::string dependence_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                            const Predictions& predictions);

}  // namespace fidservo::diagnose
