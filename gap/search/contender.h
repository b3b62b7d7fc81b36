// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a search knows of a candidate while it tries it beside a base.
#include "gap/search/search.h"

#include <cstddef>

namespace fidservo::gap {

/// Of the best one's gain, that a leader has at least.
inline constexpr double share_of_gain = 0.5;

/// Mean square in floors of what is far off.
inline constexpr double far_off_square = 9.0;

/// A trial on its way.
struct Search::Contender {
    Trial trial;
    Places coupled;  ///< settings of the base that it is coupled with
    Finding* finding;

    double promised() const { return finding->starts.empty() ? 0.0 : finding->starts.front().gain; }
    double gain() const { return trial.gain; }
    SignalFlags teachers() const { return teachers_of(*trial.candidate->effect); }

    /// The base with the candidate, where that and what it is coupled with have been fitted on a half.
    Hypothesis placed(const CrossFit& base, std::size_t side, const Hypothesis& part) const {
        return extended(base.of_half[side], coupled, part);
    }
    /// What of a whole is kept in a finding.
    Hypothesis part(const Hypothesis& whole) const {
        Hypothesis part = part_of(whole, coupled);
        part.push_back(whole.back());
        return part;
    }
    /// Of a whole, what is fitted.
    Places fitted_places(const CrossFit& base) const {
        Places places = coupled;
        places.push_back(base.of_half[0].size());
        return places;
    }
};

}  // namespace fidservo::gap
