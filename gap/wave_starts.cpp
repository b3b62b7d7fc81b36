#include "gap/wave_starts.h"

#include "gap/score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::gap {
namespace {

constexpr std::size_t most_starts = 4;

class WaveTrials {
  public:
    WaveTrials(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
               const Surroundings& beside, const Candidate& candidate)
        : predict_(predict),
          windows_(windows),
          counted_(counted),
          beside_(beside),
          base_squares_(mean_squares(windows, beside.errors)),
          candidate_(candidate) {}

    /// Of a reading, the amplitude that the errors show; of a force the best of some multiples of it, since
    /// what friction holds does not show.
    Promise sized(const PositionPeriod& period) const {
        const auto with = [&](const Wave& wave, double factor) {
            return promise(factor * wave.amplitude, period.period_mm, wave.phase_rad);
        };
        const plant::EffectParameter& amplitude = candidate_.effect->parameters[candidate_.wave->amplitude];
        if (amplitude.unit != "V") return with(period.reading_mm, um_per_mm);
        const double least = std::sqrt(12.0);  // from there on searches for known ripples end at the truth
        Promise best = with(period.force_V, least);
        for (const double factor : {1.6, 2.5, 4.0, 6.3})
            best = std::max(best, with(period.force_V, factor * least), less);
        return best;
    }

    /// Another amplitude, and a period that is other by a number of the search's steps.
    Promise beside(const Promise& from, const PositionPeriod& period, double factor, double steps) const {
        const std::vector<double>& values = from.start.back().values;
        const double change_per_mm = steps * period.step_per_mm;
        return promise(
            factor * values[candidate_.wave->amplitude],
            1.0 / (1.0 / values[candidate_.wave->period] + change_per_mm),
            values[candidate_.wave->phase] - 2.0 * std::numbers::pi * change_per_mm * period.middle_mm);
    }

    static bool less(const Promise& left, const Promise& right) { return left.gain < right.gain; }

  private:
    static constexpr double um_per_mm = 1e3;

    Promise promise(double amplitude, double period_mm, double phase_rad) const {
        std::vector<double> values = candidate_.shapes.front();
        values[candidate_.wave->amplitude] = amplitude;
        values[candidate_.wave->period] = period_mm;
        values[candidate_.wave->phase] = std::remainder(phase_rad, 2.0 * std::numbers::pi);
        Hypothesis part = part_of(beside_.base, beside_.places);
        part.push_back({candidate_.effect, std::move(values)});
        const double gain =
            gained(windows_, counted_, base_squares_, predict_(extended(beside_.base, beside_.places, part)));
        return {std::move(part), gain};
    }

    const Predict& predict_;
    std::span<const Window> windows_;
    const Wanted& counted_;
    const Surroundings& beside_;
    std::vector<double> base_squares_;
    const Candidate& candidate_;
};

}  // namespace

std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate,
                                          std::span<const PositionPeriod> periods) {
    constexpr std::size_t most_refined = 3;
    const WaveTrials trials(predict, windows, counted, beside, candidate);
    struct Start {
        PositionPeriod period;
        Promise promise;
    };
    std::vector<Start> starts;
    for (const PositionPeriod& period : periods) starts.push_back({period, trials.sized(period)});
    const auto gain = [](const Start& start) { return start.promise.gain; };
    std::ranges::sort(starts, std::greater{}, gain);
    for (Start& start : std::span(starts).first(std::min(most_refined, starts.size()))) {
        const auto take_better = [&](const Promise& from, double factor, double steps) {
            start.promise =
                std::max(start.promise, trials.beside(from, start.period, factor, steps), WaveTrials::less);
        };
        const Promise sized = start.promise;
        for (const double steps : {-0.6, -0.4, -0.2, 0.2, 0.4, 0.6}) take_better(sized, 1.0, steps);
        const Promise shifted = start.promise;
        for (const double factor : {0.75, 0.87, 1.15, 1.3}) take_better(shifted, factor, 0.0);
        const Promise sized_again = start.promise;
        for (const double steps : {-0.3, -0.2, -0.1, 0.1, 0.2, 0.3}) take_better(sized_again, 1.0, steps);
    }
    std::ranges::sort(starts, std::greater{}, gain);
    std::vector<Promise> promises;
    for (Start& start : std::span(starts).first(std::min(most_starts, starts.size())))
        promises.push_back(std::move(start.promise));
    return promises;
}

}  // namespace fidservo::gap
