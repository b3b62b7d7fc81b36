// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Before and after: what two sets of recordings of one rig say differently.
//
// The rig is diagnosed by the first set. The names that this gives are fitted to each set, all parameters
// together; then the second set is diagnosed against the rig file that states them with the second set's
// values: what it still says is new. A parameter has changed where
//
//     z = (b - a) / sqrt(std_a^2 + std_b^2)
//
// is significant at 1 % over all parameters (Holm), and the second set is predicted by the first set's values
// with errors that are larger by 1.1 or more than with its own, r.m.s. in floors: what is smaller is not
// worth a finding (gap/fit/gap_size.h). Source: Holm, Scand. J. Stat. 6, 1979.
//
// Its time is counted by effort (gap/budget.h): what has changed on a rig is no matter of how busy a computer
// is.
#include "gap/diagnosis.h"
#include "src/diagnose/read_recordings.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::compare {

/// A parameter in both sets.
struct ParameterPair {
    std::string effect, block, parameter, unit;   ///< by the catalogue
    double before, before_std, after, after_std;  ///< in its unit
    double p = 1.0;                               ///< of no difference, two-sided, over all parameters
    bool has_changed = false;                     ///< significantly, and by more than is worth a finding
};

/// All of it.
struct Comparison {
    gap::Diagnosis before;              ///< of the first set, by the rig file
    std::vector<ParameterPair> shared;  ///< of what it names
    gap::Diagnosis beyond;              ///< of the second set, beside that
    double gap_by_before = 1.0,
           gap_by_own = 1.0;  ///< of the second set, with the first set's values, its own; floors

    bool has_changed() const;
};

/// What was noted while a set was read and thinned stands among the notes of its diagnosis.
/// @param interrupted  whether the user wants an end at once
/// Throws InputError where nothing in a set can be judged, gap::BudgetEnded where the end came before
/// anything was predicted.
Comparison compare(const Rig& rig, diagnose::ReadRecordings before, diagnose::ReadRecordings after,
                   const std::function<bool()>& interrupted,
                   const std::function<void(std::string_view)>& tell);

/// For a terminal.
std::string describe(const Comparison& comparison);

/// The file of `diagnose --compare --json`: format fidservo-comparison/1 (docs/comparison.md).
std::string comparison_json(const Comparison& comparison);

}  // namespace fidservo::compare
