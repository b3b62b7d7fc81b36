// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The option --matters: how large a discrepancy of a signal may be before it is reported as a gap.
#include "gap/diagnosis.h"

#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::diagnose {

/// Parses "SIGNAL=VALUE" and "SIGNAL=VALUEUNIT": encoder in count, um or mm; hall in adc or um (of the
/// platform, in the middle of its range); tag in px; macro_command and micro_command in V or mV; image in
/// floor. Without a unit the value is in the signal's own, which is the first one listed. 0 for signals that
/// are not named. Throws InputError where an argument has another form or names a signal twice.
gap::SignalLimits what_matters(const std::vector<std::string>& arguments, const Rig& rig);

}  // namespace fidservo::diagnose
