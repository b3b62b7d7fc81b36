// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a reader of a diagnosis should know beside its numbers.
#include "gap/diagnosis.h"

namespace fidservo::gap {

/// Adds notes on what remains but does not matter by what the user says, on effects that the rig file states
/// already, and on readings that scatter more at rest than the rig file says.
void add_notes(const Evidence& evidence, const SignalLimits& matters, Diagnosis& diagnosis);

}  // namespace fidservo::gap
