// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/draw/label.h"
#include "src/selfcheck/tally/score.h"
#include "src/selfcheck/ties.h"

#include <cstddef>
#include <optional>

namespace fidservo::selfcheck {

/// The outcome of a case.
struct Outcome {
    std::size_t number = 0;
    Label label;
    Score score;
    double recording_s = 0.0;     ///< wall clock
    double diagnosis_s = 0.0;     ///< wall clock, from recordings in memory to the diagnosis
    std::optional<Tie> tie = {};  ///< set where ties are settled
};

/// One line: the true causes, the diagnosis, and whether it is right.
std::string line_of(const Outcome& outcome);

}  // namespace fidservo::selfcheck
