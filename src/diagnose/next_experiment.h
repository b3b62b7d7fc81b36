// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiment that decides between causes that the recordings do not tell apart.
#include "gap/diagnosis.h"

#include <functional>
#include <optional>

namespace fidservo {
struct Rig;
}

namespace fidservo::diagnose {

/// Of the experiments that the rig can do in 30 s or less, the one that sets the causes found and their
/// rivals furthest apart. Each is run in the simulator with each cause in turn; its rival is fitted to what
/// that would record, and what the rival then lacks, in loss (gap/fit/score.h), is how well the experiment
/// tells them apart. The worst pair counts.
/// @param interrupted  whether the user wants an end at once
/// @return nothing where nothing is tied, where no experiment would decide, and after an interrupt
std::optional<gap::ProposedExperiment> next_experiment(const Rig& rig, const gap::Diagnosis& diagnosis,
                                                       const std::function<bool()>& interrupted = {});

}  // namespace fidservo::diagnose
