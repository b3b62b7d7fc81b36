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

/// The fits of a hypothesis to each half of the windows (gap/evidence/halves.h), each judged on the other
/// half.
struct CrossFit {
    std::array<Hypothesis, 2> of_half;
    /// S_w of every window (gap/fit/score.h), predicted by the fit to the half without it.
    std::vector<double> mean_squares;
    double loss = 0.0;  ///< total loss of all windows
    /// Whether both halves have the values of one of them, because there was no time to fit them separately.
    bool is_of_one_half = false;
};

/// Mean square, in floors squared, up to which a signal is at its floor.
inline constexpr double floor_square = 1.1;

/// Each signal's mean square error, divided by that expected of the true model, minus 1; 0 if this ratio is
/// at most floor_square, which is 5 % in r.m.s.
using SignalExcess = std::array<double, signal_count>;

class CrossFitter {
  public:
    /// @param windows  the largest number of windows of one signal and one half that are fitted
    /// @param stop  called before every prediction; once it returns true, predictions are empty and results
    /// meaningless
    CrossFitter(const Evidence& evidence, std::size_t windows, std::function<bool()> stop);

    const Evidence& evidence() const { return evidence_; }
    Wanted half(std::size_t side) const;
    Predict predictor(Wanted wanted) const;

    /// The most instructive windows of a half, of some signals (gap/evidence/halves.h).
    /// @param mean_squares  of all windows under what is known already
    Wanted instructive_of(std::size_t side, const SignalFlags& signals,
                          std::span<const double> mean_squares) const;

    /// Fits the settings at some places of a hypothesis to the instructive windows of a half; the other
    /// settings keep their values.
    Fit fit_places(std::size_t side, const Hypothesis& start, const Places& places,
                   std::span<const double> mean_squares, const FitOptions& options = {}) const;

    /// Refits, from their present values, those settings of a cross fit that are estimated from any of the
    /// given signals or coupled with such ones, and judges the result.
    void fit_again(CrossFit& cross, const SignalFlags& signals) const;

    void judge(CrossFit& cross) const;
    /// Judges only the signals that the settings `different` can change, by which a cross fit differs from a
    /// base; mean squares of the other signals are taken over from the base.
    void judge_beside(const CrossFit& base, const Hypothesis& different, CrossFit& cross) const;

    /// Signals whose fits an effect influences: those from which it is estimated, and the Hall reading where
    /// the effect moves a carriage whose motion affects the platform.
    SignalFlags concerned_by(const plant::Effect& effect, const Hypothesis& whole) const;

    /// Settings of a base on which the fit of a further setting depends: those `coupled` with it and, if it
    /// is estimated from a Hall reading that the carriage's motion affects, those that move the carriage.
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
