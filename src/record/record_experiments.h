// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/record/plan.h"

namespace fidservo {

/// Homes the rig and records the experiments that are asked for on it, each from its start (start.h): all, or
/// with `resume` those that are not there whole. What an interrupted one has left is kept as
/// NAME.interrupted-1. Says beforehand how long it takes, and how each went.
/// @return whether all are there whole now; an experiment that had to be broken off is not
/// Throws InputError where the rig cannot do what is asked for, RunFault where it fails or the user stops it;
/// what was recorded stays.
bool record_experiments(const ExperimentOptions& options);

}  // namespace fidservo
