#include "gap/polish.h"

#include "gap/scaled_parameters.h"
#include "gap/score.h"
#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/core/optim.hpp>

namespace fidservo::gap {
namespace {

class LossOfLast : public cv::MinProblemSolver::Function {
  public:
    LossOfLast(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
               const Hypothesis& start)
        : predict_(predict),
          windows_(windows),
          counted_(counted),
          parameters_(start),
          first_(parameters_.size() - start.back().values.size()),
          start_(start.back()),
          wave_(wave_of(*start.back().effect)) {}

    int getDims() const override { return static_cast<int>(parameters_.size() - first_); }
    double calc(const double* scaled) const override {
        const double loss = total_loss(windows_, counted_, predict_(at(scaled)));
        return std::min(loss, 1e12);  // of what the plant refuses it is infinite
    }

    Hypothesis at(const double* scaled) const {
        std::vector<double> all = parameters_.values;
        std::copy_n(scaled, getDims(), all.begin() + static_cast<std::ptrdiff_t>(first_));
        Hypothesis there = parameters_.at(all);
        if (wave_) keep_in_step(there.back().values);
        return there;
    }
    std::vector<double> start() const {
        return {parameters_.values.begin() + static_cast<std::ptrdiff_t>(first_), parameters_.values.end()};
    }

  private:
    /// Turns the phase with the period.
    void keep_in_step(std::vector<double>& values) const {
        values[wave_->phase] =
            phase_in_step(values[wave_->phase], start_.values[wave_->period], values[wave_->period]);
    }

    const Predict& predict_;
    std::span<const Window> windows_;
    const Wanted& counted_;
    ScaledParameters parameters_;
    std::size_t first_;
    plant::EffectSetting start_;
    std::optional<WaveParameters> wave_;
};

/// A simplex of one parameter: steps to either side as long as one leads down, then shorter ones.
Fit stepped(const LossOfLast& loss, double best, double least, double step, double enough) {
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
           const Hypothesis& start) {
    constexpr int most_predictions = 100;
    constexpr double first_step = 0.1, enough = 1e-3;  // scales
    const auto loss = cv::makePtr<LossOfLast>(predict, windows, counted, start);
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
