// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Reduces long recordings for a diagnosis.
#include "core/recording.h"

#include <string>
#include <vector>

namespace fidservo::diagnose {

/// If the recordings last longer than ten minutes in total, every n-th minute of each one longer than two
/// minutes is kept, as a recording of its own: ten minutes of an hour are nearly as informative, and a search
/// needs many predictions.
/// @param notes  receives what was left out
std::vector<Recording> thinned(std::vector<Recording> recordings, std::vector<std::string>& notes);

}  // namespace fidservo::diagnose
