// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The gap of every recording and signal, before and after.
#include "src/diagnose/report/predictions.h"

#include <string>

namespace fidservo::diagnose {

/// A table with a row a recording, two cells a signal, coloured by size.
std::string recording_gaps_html(const gap::Evidence& evidence, const Predictions& predictions);

}  // namespace fidservo::diagnose
