// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hypothesis fitted on each half of the windows and judged on the other.
#include "gap/candidates/coupling.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// A hypothesis fitted on each half of the windows (gap/evidence/halves.h).
struct CrossFit {
    std::array<Hypothesis, 2> of_half;
    std::vector<double> mean_squares;  ///< S_w of every window, predicted by what was fitted without its half
    double loss = 0.0;                 ///< of them all
};

/// What each signal's mean square exceeds the floor by; 0 up to 5 % above the floor.
using SignalExcess = std::array<double, signal_count>;

class CrossFitter {
  public:
    /// @param windows  of a signal and a half, that are fitted
    /// @param stop  asked at every prediction; once true, what is returned is worth nothing
    CrossFitter(const Evidence& evidence, std::size_t windows, std::function<bool()> stop);

    const Evidence& evidence() const { return evidence_; }
    Wanted half(std::size_t side) const;
    Predict predictor(Wanted wanted) const;

    /// Those windows of a half, of some signals, from which most is learnt where a base leaves mean squares.
    Wanted instructive_of(std::size_t side, const SignalFlags& signals,
                          std::span<const double> mean_squares) const;

    /// Fits the settings at some places on a half, the others being as they are.
    Fit fit_places(std::size_t side, const Hypothesis& start, const Places& places,
                   std::span<const double> mean_squares, const FitOptions& options = {}) const;

    /// Fits all parameters, from where they are, of the parts of the hypothesis that meet some signals.
    void fit_again(CrossFit& cross, const SignalFlags& signals) const;

    void judge(CrossFit& cross) const;
    /// Judges the signals that some settings change, in which the cross fit differs from a base; the rest is
    /// as there.
    void judge_beside(const CrossFit& base, const Hypothesis& different, CrossFit& cross) const;

    /// Signals at whose fits an effect has a say: its teachers, and the Hall reading where the effect moves a
    /// carriage that the platform feels.
    SignalFlags concerned_by(const plant::Effect& effect, const Hypothesis& whole) const;

    /// Settings of a base on which the fit of a further one depends: those `coupled` with it, and what moves
    /// the carriage where the platform feels that.
    Places met_by(const Hypothesis& base, const plant::EffectSetting& further, Places coupled) const;

    SignalExcess excess(std::span<const double> mean_squares) const;
    Comparison compared(const CrossFit& base, const CrossFit& fitted) const;

  private:
    void judge_signals(const CrossFit& base, const SignalFlags& signals, CrossFit& cross) const;

    const Evidence& evidence_;
    std::size_t windows_;
    std::function<bool()> stop_;
    std::vector<std::uint8_t> half_;
};

}  // namespace fidservo::gap
