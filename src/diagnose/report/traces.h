// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recorded and predicted signals over time.
#include "src/diagnose/report/predictions.h"

#include <string>

namespace fidservo::diagnose {

/// For each signal, the recording with the largest error of the rig file's prediction: recorded, predicted by
/// the rig file, predicted with the explanation, and below it both errors. In full detail where the gap is
/// largest, thinned elsewhere.
std::string traces_html(const gap::Evidence& evidence, const Predictions& predictions);

}  // namespace fidservo::diagnose
