// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/polish.h"

#include "gap/candidates/scaled_parameters.h"
#include "gap/candidates/wave.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/core/optim.hpp>

namespace fidservo::gap {
namespace {

class LossOfPart : public cv::MinProblemSolver::Function {
  public:
    LossOfPart(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
               const Hypothesis& start, const Places& places)
        : predict_(predict),
          windows_(windows),
          counted_(counted),
          start_(start),
          places_(places),
          part_(part_of(start, places)),
          parameters_(part_),
          free_(free_of(part_, parameters_)) {}

    int getDims() const override { return static_cast<int>(free_.size()); }
    double calc(const double* scaled) const override {
        constexpr double most_loss = 1e12;  // it is infinite for values that the plant refuses
        const double loss = total_loss(windows_, counted_, predict_(at(scaled)));
        return std::min(loss, most_loss);
    }

    Hypothesis at(const double* scaled) const {
        std::vector<double> values = parameters_.values;
        for (std::size_t k = 0; k < free_.size(); ++k) values[free_[k]] = scaled[k];
        Hypothesis part = parameters_.at(values);
        for (std::size_t k = 0; k < part.size(); ++k) keep_in_step(part_[k], part[k].values);
        return with_part(start_, places_, part);
    }
    std::vector<double> start() const {
        std::vector<double> values;
        for (const std::size_t k : free_) values.push_back(parameters_.values[k]);
        return values;
    }

  private:
    /// All parameters but those of waves on which the loss does not depend locally, such as an absent
    /// harmonic.
    static std::vector<std::size_t> free_of(const Hypothesis& part, const ScaledParameters& parameters) {
        std::vector<std::size_t> free;
        std::size_t k = 0;
        for (const plant::EffectSetting& setting : part)
            for (std::size_t own = 0; own < setting.values.size(); ++own, ++k)
                if (!parameters.is_level(k) || !wave_of(*setting.effect)) free.push_back(k);
        return free;
    }

    /// Changes a wave's phase with its period such that it stays in phase in the middle of the rail.
    static void keep_in_step(const plant::EffectSetting& from, std::vector<double>& values) {
        if (const std::optional<WaveParameters> wave = wave_of(*from.effect))
            values[wave->phase] =
                phase_in_step(values[wave->phase], from.values[wave->period], values[wave->period]);
    }

    const Predict& predict_;
    std::span<const Window> windows_;
    const Wanted& counted_;
    const Hypothesis& start_;
    const Places& places_;
    Hypothesis part_;
    ScaledParameters parameters_;
    std::vector<std::size_t> free_;  ///< indices of the parameters that are fitted
};

/// Minimises over a single parameter: steps to either side while the loss decreases, then halves the step.
Fit stepped(const LossOfPart& loss, double best, double least, double step, double enough) {
    while (step > enough) {
        const auto better = [&](double there) {
            const double value = loss.calc(&there);
            if (value >= least) return false;
            best = there;
            least = value;
            return true;
        };
        if (!better(best + step) && !better(best - step)) step *= 0.5;
    }
    return {loss.at(&best), least, {}};
}

}  // namespace

Fit polish(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
           const Hypothesis& start, const Places& places) {
    constexpr int most_predictions = 100;
    constexpr double first_step = 0.1, enough = 1e-3;  // in scales
    const auto loss = cv::makePtr<LossOfPart>(predict, windows, counted, start, places);
    std::vector<double> best = loss->start();
    const double loss_at_start = loss->calc(best.data());
    if (loss->getDims() < 2) return stepped(*loss, best.front(), loss_at_start, first_step, enough);
    const auto solver = cv::DownhillSolver::create(
        loss, cv::Mat(1, loss->getDims(), CV_64F, cv::Scalar(first_step)),
        cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, most_predictions, enough));
    const double least = solver->minimize(best);
    return least < loss_at_start ? Fit{loss->at(best.data()), least, {}} : Fit{start, loss_at_start, {}};
}

}  // namespace fidservo::gap
