// SPDX-License-Identifier: GPL-3.0-or-later
// Waves along the rail, whose loss has a local minimum for each course that a carriage may take.
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/fit/score.h"
#include "gap/search/contender.h"
#include "gap/search/search.h"
#include "gap/starts/scatter.h"
#include "gap/starts/wave_scan.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

/// Whether a wave of force is so strong that the balance of forces has shown it already.
bool shows_in_balance(const plant::EffectSetting& setting, const WaveParameters& wave,
                      const MacroParameters& macro) {
    constexpr double strong_mm_per_s = 20.0;
    return setting.values[wave.amplitude] * macro.velocity_gain_mm_per_s_per_V > strong_mm_per_s;
}

/// Whether the carriage hangs on a belt: it is simulated step by step, which takes too long for a thousand
/// waves.
bool swings(const Rig& rig, const Hypothesis& hypothesis) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, hypothesis);
    return plant::make_macro_axis(parameters.axis, parameters.tick_s).has_belt;
}

}  // namespace

std::optional<plant::EffectSetting> Search::scanned_wave(const Hypothesis& beside,
                                                         const Candidate& wave) const {
    constexpr std::ptrdiff_t fewest_run_away = 3;
    constexpr double away_mm = 10.0;
    const Evidence& evidence = fitter_.evidence();
    if (swings(evidence.rig(), beside)) return {};
    const std::vector<Window>& windows = evidence.windows();
    Wanted far_off = only_of(windows, fitter_.half(0), only(Signal::encoder));
    const std::vector<double> squares = mean_squares(windows, fitter_.predictor(far_off)(beside));
    const double away_floors =
        away_mm / (evidence.floor(Signal::encoder) * evidence.rig().macro.encoder_resolution_mm);
    if (std::ranges::count_if(squares, [&](double square) { return square > away_floors * away_floors; }) <
        fewest_run_away)
        return {};
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (!(squares[w] > far_off_square)) far_off[w] = 0;
    return gap::scan_for_wave([&](Wanted wanted) { return fitter_.predictor(std::move(wanted)); }, windows,
                              far_off, beside, wave, evidence.rig().macro);
}

bool Search::scan_for_wave(const CrossFit& base, std::span<const Candidate* const> added) {
    bool is_found = false;
    for (Contender& contender : contenders(base, added)) {
        const Candidate& candidate = *contender.trial.candidate;
        Finding& finding = *contender.finding;
        if (!candidate.wave || !candidate.wave->is_force || finding.is_scanned) continue;
        finding.is_scanned = true;
        const Hypothesis& known = finding.fitted[0];
        if (!known.empty() && shows_in_balance(known.back(), *candidate.wave, fitter_.evidence().rig().macro))
            continue;
        std::optional<plant::EffectSetting> wave = scanned_wave(base.of_half[0], candidate);
        throw_if_exhausted();
        if (!wave) continue;
        const std::vector<Window>& windows = fitter_.evidence().windows();
        const Wanted counted = only_of(windows, fitter_.half(0), contender.teachers());
        const Predict predict = fitter_.predictor(counted);
        const std::vector<double> squares = mean_squares(windows, predict(base.of_half[0]));
        const auto gain_of = [&](const Hypothesis& part) {
            return gained(windows, counted, squares, predict(contender.placed(base, 0, part)));
        };
        Hypothesis scanned = part_of(base.of_half[0], contender.coupled);
        scanned.push_back(*std::move(wave));
        const double gain = gain_of(scanned),
                     gain_of_known = known.empty() ? contender.promised() : gain_of(known);
        if (gain <= gain_of_known) continue;
        finding.starts = {{std::move(scanned), gain}};
        if (!known.empty()) finding.starts.push_back({known, gain_of_known});
        finding.fitted = {};
        finding.sought = Sought::nowhere;
        is_found = true;
    }
    return is_found;
}

Search::Contender Search::scattered(const CrossFit& base, const Contender& contender) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const std::size_t place = base.of_half[0].size();
    const std::array<Hypothesis, 2>& of_half = contender.trial.fitted.of_half;
    Contender there = contender;
    parallel_for(2, [&](std::size_t side) {
        const Wanted wanted =
            fitter_.instructive_of(side, contender.teachers(), contender.trial.fitted.mean_squares);
        there.trial.fitted.of_half[side] =
            scatter(fitter_.predictor(wanted), windows, wanted, of_half[side], {place}).hypothesis;
    });
    const std::array<Hypothesis, 2> drawn = there.trial.fitted.of_half;
    parallel_for(2, [&](std::size_t side) {
        // The other half may have found a deeper minimum.
        const auto loss_of = [&](const Hypothesis& whole) {
            return loss_on_half(side, whole, *contender.trial.candidate);
        };
        Hypothesis other = drawn[side];
        other[place] = drawn[1 - side][place];
        Contender start = contender;
        start.trial.fitted.of_half[side] = loss_of(other) < loss_of(drawn[side]) ? other : drawn[side];
        there.trial.fitted.of_half[side] = polished(start, side, {place}).hypothesis;
    });
    judge_both_halves(base, there);
    return there;
}

}  // namespace fidservo::gap
