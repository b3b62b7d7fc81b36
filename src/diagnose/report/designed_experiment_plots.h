// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The designed experiment in the report: what it commands, and what each explanation predicts of it.
#include "src/diagnose/designed_experiment.h"

#include <string>

namespace fidservo::diagnose {

/// Setpoints over time; the commands and readings that each explanation predicts; and, for each that may be
/// true, by how much the other one would still be wrong after its values have adjusted themselves: r.m.s. in
/// each window of 1 s of the signal that tells most, in floors, beside what the truth itself leaves.
std::string designed_experiment_html(const Rig& rig, const DesignedNext& next);

}  // namespace fidservo::diagnose
