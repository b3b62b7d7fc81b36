// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The gap of every recording and signal, without and with the explanation.
#include "src/diagnose/report/predictions.h"

#include <string>

namespace fidservo::diagnose {

/// A table with a row for each recording and two cells for each signal, coloured by size.
std::string recording_gaps_html(const gap::Evidence& evidence, const Predictions& predictions);

}  // namespace fidservo::diagnose
