// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A candidate during one step of a search.
#include "gap/numbers.h"
#include "gap/search/search.h"

#include <cstddef>

namespace fidservo::gap {

/// Least gain of a leader (Trial::is_leader), relative to the largest gain.
inline constexpr double share_of_gain = larger_part;

/// Mean square, floors^2, above which a window counts as far off.
inline constexpr double far_off_square = far_off_floors * far_off_floors;

/// A trial in progress.
struct Search::Contender {
    Trial trial;
    Places coupled;  ///< indices of the base's settings that are fitted together with it
    Finding* finding;

    double promised() const { return finding->starts.empty() ? 0.0 : finding->starts.front().gain; }
    double gain() const { return trial.gain; }
    SignalFlags teachers() const { return teachers_of(*trial.candidate->effect); }

    /// The base as fitted on one half, with the candidate appended and the fitted values put in.
    /// @param part  the coupled settings, then the candidate's
    Hypothesis placed(const CrossFit& base, std::size_t side, const Hypothesis& part) const {
        return extended(base.of_half[side], coupled, part);
    }
    /// The coupled settings and the candidate of a whole hypothesis, as a finding stores them.
    Hypothesis part(const Hypothesis& whole) const {
        Hypothesis part = part_of(whole, coupled);
        part.push_back(whole.back());
        return part;
    }
    /// Indices of the settings that are fitted, in the base with the candidate.
    Places fitted_places(const CrossFit& base) const {
        Places places = coupled;
        places.push_back(base.of_half[0].size());
        return places;
    }
};

}  // namespace fidservo::gap
