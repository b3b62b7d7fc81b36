// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Lists a log's content, and drafts a map to be edited.
#include "src/import/log.h"

#include <string>
#include <vector>

namespace fidservo::imports {

/// A map (fidservo-map/1) with the assignments that names and units suggest, under comments that list every
/// signal with its count, rate, unit and range. Guesses are marked GUESS, missing statements are marked SAY.
std::string draft_map(const std::vector<Log>& logs);

}  // namespace fidservo::imports
