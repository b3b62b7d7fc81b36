// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/wave_starts.h"

#include "gap/balance/balanced_waves.h"
#include "gap/candidates/wave.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fidservo::gap {
namespace {

constexpr std::size_t parameters_of_wave = 3;

/// Steps of a local search over a wave's parameters.
struct Steps {
    double factor = 1.15;     ///< of the amplitude
    double phase_rad = 0.15;  ///< in the middle of the rail
    double per_mm =
        0.25 / (2.0 * rail_middle_mm);  ///< of the inverse period: an eighth of a turn at the rail's ends

    Steps halved() const { return {std::sqrt(factor), 0.5 * phase_rad, 0.5 * per_mm}; }
};

std::array<plant::EffectSetting, 2 * parameters_of_wave> neighbours(const plant::EffectSetting& setting,
                                                                    const WaveParameters& wave,
                                                                    const Steps& steps) {
    std::array<plant::EffectSetting, 2 * parameters_of_wave> around;
    around.fill(setting);
    for (const std::size_t side : {0, 1}) {
        const double sign = side == 0 ? 1.0 : -1.0;
        double& amplitude = around[side].values[wave.amplitude];
        amplitude = std::min(amplitude * std::pow(steps.factor, sign),
                             setting.effect->parameters[wave.amplitude].high);
        around[2 + side].values[wave.phase] += sign * steps.phase_rad;
        std::vector<double>& values = around[2 * 2 + side].values;
        const double from_mm = values[wave.period];
        values[wave.period] = 1.0 / (1.0 / from_mm + sign * steps.per_mm);
        values[wave.phase] = phase_in_step(values[wave.phase], from_mm, values[wave.period]);
    }
    return around;
}

}  // namespace

std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate, std::span<const PositionPeriod> periods,
                                          std::span<const plant::EffectSetting> balanced) {
    constexpr std::size_t most_climbed = narrow_beam;
    constexpr int rounds = 4;
    const std::vector<double> base_squares = mean_squares(windows, beside.errors);
    const auto promise = [&](plant::EffectSetting setting) {
        return promise_of(std::move(setting), predict, windows, counted, beside, base_squares);
    };
    std::vector<Promise> promises;
    for (const PositionPeriod& period : periods) promises.push_back(promise(wave_at(candidate, period)));
    for (const plant::EffectSetting& wave : balanced)
        if (wave.effect == candidate.effect) promises.push_back(promise(wave));
    std::ranges::sort(promises, std::greater{}, &Promise::gain);
    const double enough = worth_of_wave * total_loss(windows, counted, beside.errors);
    for (Promise& best : std::span(promises).first(std::min(most_climbed, promises.size()))) {
        if (best.gain < enough) break;
        Steps steps;
        for (int round = 0; round < rounds; ++round, steps = steps.halved())
            for (plant::EffectSetting& neighbour : neighbours(best.start.back(), *candidate.wave, steps)) {
                Promise there = promise(std::move(neighbour));
                if (there.gain > best.gain) best = std::move(there);
            }
    }
    std::ranges::sort(promises, std::greater{}, &Promise::gain);
    if (promises.size() > most_starts) promises.resize(most_starts);
    return promises;
}

}  // namespace fidservo::gap
