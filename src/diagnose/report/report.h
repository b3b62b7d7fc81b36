// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The report of `fidservo diagnose`: one self-contained HTML file.
#include "gap/diagnosis.h"
#include "src/diagnose/report/next_steps.h"

#include <string>

namespace fidservo::diagnose {

/// The whole file.
/// @param evidence  that the diagnosis was made from
std::string diagnosis_report(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                             const Request& request);

}  // namespace fidservo::diagnose
