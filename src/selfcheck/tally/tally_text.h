// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/tally/tally.h"

#include <string>

namespace fidservo::selfcheck {

/// A tally as text for the terminal: figures with their 95 % intervals and limits, then power against size,
/// reliability, and the names given for each class. Figures without cases are left out.
std::string text_of(const Tally& tally);

}  // namespace fidservo::selfcheck
