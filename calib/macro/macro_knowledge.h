// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well each figure of the macro stage is known: errors correlated in time, recordings that differ, what
// the model lacks, what was taken as zero.
#include "calib/macro/macro_figures.h"
#include "calib/macro/macro_identification.h"
#include "calib/macro/macro_lack.h"
#include "calib/macro/macro_recordings.h"

namespace fidservo::calib {

/// All that says how well each figure is known.
struct MacroKnowledge {
    MacroFigures value;
    MacroFigures most_std;  ///< beyond it, a figure is no figure
    std::array<VarianceSum, macro_figure_count> variance;
    std::array<MacroAgreement, macro_figure_count> agreement;
    MacroLacks lacks;
    MacroMissed missed;
    MacroFigures systematic;
};

/// @param threshold_V  of the dead zone, known to `threshold_std_V`
MacroKnowledge knowledge_of(const MacroEstimator& estimator, const MacroFit& fit, const MacroBuild& build,
                            double threshold_V, double threshold_std_V);

/// The figures on which recordings contradict each other.
std::vector<std::size_t> contradicted(const MacroKnowledge& known);

MacroEstimate estimate_of(const MacroKnowledge& known, MacroFigure figure);

}  // namespace fidservo::calib
