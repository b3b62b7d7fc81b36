// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Comparison of two sets of recordings of one rig: what has changed between them.
//
// The rig is diagnosed from the first set. The effects named are fitted to each set, all parameters together;
// then the second set is diagnosed with these effects at the second set's values in the rig file, so that
// what is named now is new. A parameter has changed where
//
//     z = (b - a) / sqrt(std_a^2 + std_b^2)
//
// is significant at 1 % over all parameters (Holm), and the second set's prediction errors with the first
// set's values exceed those with its own by a factor of 1.1 or more, r.m.s. in floors; less is not worth a
// finding (gap/fit/gap_size.h). The same factor is asked of what is named anew. Source: Holm, Scand. J. Stat.
// 6, 1979.
//
// The time is counted by effort (gap/budget.h), so that the result does not depend on how busy the computer
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

/// A parameter as fitted to both sets.
struct ParameterPair {
    std::string effect, block, parameter, unit;   ///< as in the catalogue
    double before, before_std, after, after_std;  ///< in its unit
    double p = 1.0;            ///< two-sided p-value of no difference, corrected for all parameters
    bool has_changed = false;  ///< significantly, and by more than is worth a finding
};

/// The whole result.
struct Comparison {
    gap::Diagnosis before;              ///< diagnosis of the first set with the rig file
    std::vector<ParameterPair> shared;  ///< parameters of the effects named in it
    gap::Diagnosis beyond;              ///< diagnosis of the second set with these effects in the rig file
    double gap_by_before = 1.0,
           /// Prediction error of the second set with the first set's values, and with its own; floors.
        gap_by_own = 1.0;

    bool has_changed() const;
    /// Whether what is named, or left unexplained, in B beside A's effects is new: some signal of B is
    /// predicted worse with these effects, by a factor of 1.1 or more, than what they leave of it in A, or
    /// than noise.
    bool has_news() const;
};

/// What was noted while a set was read and thinned stands among the notes of its diagnosis.
/// @param interrupted  whether the user wants an end at once
/// Throws InputError where nothing in a set can be judged, gap::BudgetEnded where the end came before
/// anything was predicted.
Comparison compare(const Rig& rig, diagnose::ReadRecordings before, diagnose::ReadRecordings after,
                   const std::function<bool()>& interrupted,
                   const std::function<void(std::string_view)>& tell);

/// The result as text for a terminal.
std::string describe(const Comparison& comparison);

/// The file of `diagnose --compare --json`: format fidservo-comparison/1 (docs/comparison.md).
std::string comparison_json(const Comparison& comparison);

}  // namespace fidservo::compare
