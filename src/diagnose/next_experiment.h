// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Chooses the experiment that best distinguishes causes which the recordings do not.
#include "gap/diagnosis.h"

#include <functional>
#include <optional>

namespace fidservo {
struct Rig;
}

namespace fidservo::diagnose {

/// Of the experiments that the rig can do in 30 s or less, the one that best distinguishes the causes found
/// from their rivals. Each is simulated with each cause in turn; the rival is fitted to the simulated
/// recording, and its remaining loss (gap/fit/score.h) measures how well the experiment distinguishes them.
/// The worst pair counts.
/// @param interrupted  whether the user wants an end at once
/// @return empty where no causes are tied, where no experiment would decide, and after an interrupt
std::optional<gap::ProposedExperiment> next_experiment(const Rig& rig, const gap::Diagnosis& diagnosis,
                                                       const std::function<bool()>& interrupted = {});

}  // namespace fidservo::diagnose
