// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The designed experiment in the report: what it commands, and what each explanation predicts of it.
#include "src/diagnose/designed_experiment.h"

#include <string>

namespace fidservo::diagnose {

/// Setpoints over time; the commands and readings that each explanation predicts; and, for each explanation
/// as the truth, the error that the other one would still have after a fit of its values: r.m.s. in each
/// window of 1 s of the most informative signal, in floors, beside the error of the true explanation.
std::string designed_experiment_html(const Rig& rig, const DesignedNext& next);

}  // namespace fidservo::diagnose
