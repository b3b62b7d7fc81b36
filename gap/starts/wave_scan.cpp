// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/wave_scan.h"

#include "core/macro_parameters.h"
#include "core/parallel.h"
#include "gap/candidates/wave.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>

namespace fidservo::gap {
namespace {

/// Step of the inverse period: it turns the phase by half a turn at the rail's ends, and by much less over
/// the usual travel about the middle.
constexpr double step_per_mm = 0.5 / rail_middle_mm;
constexpr double longest_wave_mm = 25.0;
constexpr int phases = 6;
constexpr double step_rad = 2.0 * std::numbers::pi / phases;
constexpr std::array speeds_mm_per_s{0.7, 1.5, 4.0};
constexpr double speed_factor = 1.8;  // about half way from one speed to the next

struct Scanned {
    double speed_mm_per_s, per_mm, middle_rad;  ///< phase in the middle of the rail
    double loss = 0.0;
};

std::vector<Scanned> all_waves() {
    std::vector<Scanned> all;
    for (int row = 0; 1.0 / longest_wave_mm + row * step_per_mm < 1.0 / shortest_wave_mm; ++row)
        for (const double speed_mm_per_s : speeds_mm_per_s)
            for (int k = 0; k < phases; ++k)
                all.push_back({speed_mm_per_s, 1.0 / longest_wave_mm + row * step_per_mm,
                               step_rad * (k + 0.5 * (row % 2))});
    return all;
}

/// A wave, and those half a step to either side of it.
std::vector<Scanned> neighbours_of(const Scanned& wave) {
    std::vector<Scanned> all;
    for (const double factor : {1.0 / speed_factor, 1.0, speed_factor})
        for (const double steps : {-0.5, 0.0, 0.5})
            for (const double turns : {-0.5, 0.0, 0.5})
                all.push_back({factor * wave.speed_mm_per_s, wave.per_mm + steps * step_per_mm,
                               wave.middle_rad + turns * step_rad});
    return all;
}

/// The best of some sorted waves, none of which has a period next to a better one's.
std::vector<Scanned> best_valleys(std::span<const Scanned> sorted, std::size_t most) {
    std::vector<Scanned> best;
    for (const Scanned& wave : sorted) {
        const bool is_beside_another = std::ranges::any_of(best, [&](const Scanned& other) {
            return std::abs(other.per_mm - wave.per_mm) < most_steps_apart * step_per_mm;
        });
        if (!is_beside_another) best.push_back(wave);
        if (best.size() == most) break;
    }
    return best;
}

/// The windows asked for, ordered such that the first few are already spread over all of them: by golden
/// sections of those left.
std::vector<std::size_t> spread_over_windows(const Wanted& asked) {
    std::vector<std::size_t> rest, order;
    for (std::size_t w = 0; w < asked.size(); ++w)
        if (asked[w] != 0) rest.push_back(w);
    double share = 0.0;
    while (!rest.empty()) {
        share = std::fmod(share + golden_section, 1.0);
        const auto at = rest.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(rest.size()));
        order.push_back(*at);
        rest.erase(at);
    }
    return order;
}

}  // namespace

std::optional<plant::EffectSetting> scan_for_wave(const std::function<Predict(Wanted)>& predictor,
                                                  std::span<const Window> windows, const Wanted& asked,
                                                  const Hypothesis& base, const Candidate& candidate,
                                                  const MacroParameters& macro) {
    constexpr std::size_t at_first = 5, then = 15;  // numbers of windows
    constexpr std::size_t most_then = 240, most_valleys = 12, most_at_last = 60;
    const std::vector<std::size_t> order = spread_over_windows(asked);
    if (order.empty()) return {};
    const auto setting = [&](const Scanned& wave) {
        plant::EffectSetting set{candidate.effect, candidate.shapes.front()};
        const double period_mm = 1.0 / wave.per_mm;
        set.values[candidate.wave->amplitude] =
            std::min(wave.speed_mm_per_s / macro.velocity_gain_mm_per_s_per_V,
                     candidate.effect->parameters[candidate.wave->amplitude].high);
        set.values[candidate.wave->period] = period_mm;
        set.values[candidate.wave->phase] =
            phase_in_step(wave.middle_rad, std::numeric_limits<double>::infinity(), period_mm);
        return set;
    };
    /// Adds to each wave's loss that in some windows of the order, and sorts by it.
    const auto judge = [&](std::vector<Scanned>& waves, std::size_t first, std::size_t end) {
        Wanted wanted(asked.size(), 0);
        for (std::size_t k = first; k < std::min(end, order.size()); ++k) wanted[order[k]] = 1;
        const Predict predict = predictor(wanted);
        parallel_for(waves.size(), [&](std::size_t k) {
            Hypothesis whole = base;
            whole.push_back(setting(waves[k]));
            waves[k].loss += total_loss(windows, wanted, predict(whole));
        });
        std::ranges::sort(waves, {}, &Scanned::loss);
    };
    std::vector<Scanned> waves = all_waves();
    judge(waves, 0, at_first);
    waves.resize(std::min(waves.size(), most_then));
    judge(waves, at_first, then);
    std::vector<Scanned> finer;
    for (const Scanned& wave : best_valleys(waves, most_valleys))
        std::ranges::move(neighbours_of(wave), std::back_inserter(finer));
    judge(finer, 0, then);
    finer.resize(std::min(finer.size(), most_at_last));
    judge(finer, then, order.size());
    return setting(finer.front());
}

}  // namespace fidservo::gap
