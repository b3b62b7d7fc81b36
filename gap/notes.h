// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Notes for the reader of a diagnosis, in addition to its numbers.
#include "gap/diagnosis.h"

namespace fidservo::gap {

/// Adds notes on remaining discrepancies below the limits that the user has stated (`matters`), on effects
/// that the rig file states already, and on readings that are noisier at rest than the rig file says.
void add_notes(const Evidence& evidence, const SignalLimits& matters, Diagnosis& diagnosis);

}  // namespace fidservo::gap
