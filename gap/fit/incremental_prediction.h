// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Predictions for a fit. If a hypothesis differs from an earlier one in a single setting, or has one more,
// only the windows that this setting reaches are predicted again, and the carriage is simulated again only
// where the setting changes its motion. The errors are the same as those of Evidence::errors.
#include "gap/evidence.h"

#include <memory>
#include <mutex>

namespace fidservo::gap {

/// Errors of hypotheses on some windows, as a Predict for fits.
class IncrementalPrediction {
  public:
    /// @param beside  settings that precede those of every prediction
    IncrementalPrediction(const Evidence& evidence, Hypothesis beside, Wanted wanted)
        : evidence_(evidence), beside_(std::move(beside)), wanted_(std::move(wanted)) {}

    /// Errors under the preceding settings followed by these. Safe to call from several threads at once.
    /// Throws BudgetEnded.
    Errors operator()(const Hypothesis& settings);

  private:
    /// A prediction from which later ones are derived, with the carriage's paths.
    struct Known {
        Hypothesis settings;
        Errors errors;
        std::shared_ptr<const CarriagePaths> paths;
    };

    Errors predicted_whole(Hypothesis whole, const Hypothesis& settings);

    const Evidence& evidence_;
    Hypothesis beside_;
    Wanted wanted_;
    std::mutex access_;
    std::shared_ptr<const Known> known_;
};

}  // namespace fidservo::gap
