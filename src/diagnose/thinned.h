// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Long recordings, as far as a diagnosis looks at them.
#include "core/recording.h"

#include <string>
#include <vector>

namespace fidservo::diagnose {

/// Of recordings that last longer than ten minutes together, every n-th minute of each that is longer than
/// two, as recordings of their own that begin in the middle: what an hour says ten minutes of it say, too,
/// and a search needs many predictions.
/// @param notes  is told what was left out
std::vector<Recording> thinned(std::vector<Recording> recordings, std::vector<std::string>& notes);

}  // namespace fidservo::diagnose
