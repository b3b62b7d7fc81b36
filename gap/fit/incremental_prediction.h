// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Predictions for a fit. A hypothesis that differs from an earlier one in a single setting, or has one more,
// is predicted again in those windows alone that this setting reaches, and the carriage is followed again
// only where it moves otherwise. The values are those of Evidence::errors, whatever was predicted before.
#include "gap/evidence.h"

#include <memory>
#include <mutex>

namespace fidservo::gap {

class IncrementalPrediction {
  public:
    /// @param beside  settings that stand before all that are asked for
    IncrementalPrediction(const Evidence& evidence, Hypothesis beside, Wanted wanted)
        : evidence_(evidence), beside_(std::move(beside)), wanted_(std::move(wanted)) {}

    /// Errors with some settings beside the known ones, as Evidence::errors has them. Safe to call from
    /// several threads at once. Throws BudgetEnded.
    Errors operator()(const Hypothesis& settings);

  private:
    /// A prediction, and where it has the carriage go.
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
