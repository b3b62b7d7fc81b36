// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/tally/tally.h"

#include <string>

namespace fidservo::selfcheck {

/// What a terminal shows of a tally: figures with their 95 % intervals and limits, then power against size,
/// reliability, and what was named by class. What no case was met of is left out.
std::string text_of(const Tally& tally);

}  // namespace fidservo::selfcheck
