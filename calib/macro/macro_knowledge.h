// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The uncertainty of each figure of the macro stage, from errors correlated in time, differences between
// recordings, forces that the model lacks, and parameters that were taken as zero.
#include "calib/macro/macro_figures.h"
#include "calib/macro/macro_identification.h"
#include "calib/macro/macro_lack.h"
#include "calib/macro/macro_recordings.h"

namespace fidservo::calib {

/// The contributions to each figure's uncertainty.
struct MacroKnowledge {
    MacroFigures value;
    MacroFigures most_std;  ///< standard error above which a figure is useless
    std::array<VarianceSum, macro_figure_count> variance;
    std::array<MacroAgreement, macro_figure_count> agreement;
    MacroLacks lacks;
    MacroMissed missed;
    MacroFigures systematic;
};

/// @param threshold_V  of the dead zone, with standard error `threshold_std_V`
MacroKnowledge knowledge_of(const MacroEstimator& estimator, const MacroFit& fit, const MacroBuild& build,
                            double threshold_V, double threshold_std_V);

/// The figures on which recordings contradict each other.
std::vector<std::size_t> contradicted(const MacroKnowledge& known);

MacroEstimate estimate_of(const MacroKnowledge& known, MacroFigure figure);

}  // namespace fidservo::calib
