// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a log holds, for people, and a map to edit.
#include "src/import/log.h"

#include <string>
#include <vector>

namespace fidservo::imports {

/// A map (fidservo-map/1) that binds what the names and units tell, under comments that list every signal
/// with its count, rate, unit and range. What is guessed is marked GUESS, what has to be said is marked SAY.
std::string draft_map(const std::vector<Log>& logs);

}  // namespace fidservo::imports
