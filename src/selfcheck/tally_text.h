#pragma once
#include "src/selfcheck/tally.h"

#include <string>

namespace fidservo::selfcheck {

/// What a terminal shows of a tally: figures with their 95 % intervals and limits, then power against size,
/// reliability, and the classes that were not always named first.
std::string text_of(const Tally& tally);

}  // namespace fidservo::selfcheck
