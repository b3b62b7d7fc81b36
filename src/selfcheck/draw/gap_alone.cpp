// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/gap_alone.h"

#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "src/selfcheck/draw/campaign.h"

#include <algorithm>
#include <cmath>

namespace fidservo::selfcheck {

double gap_alone(const Rig& nominal, const TrueRig& rig, std::uint64_t campaign_seed) {
    // Enough for a hundredth of a floor, but not for bristles that are stiff.
    constexpr int few_substeps = 5;
    const bool is_stiff = rig.departures.friction.bristles.has_value();
    const gap::Evidence evidence(
        nominal, record_campaign(nominal, rig, campaign_seed,
                                 is_stiff ? std::optional<int>{} : std::optional<int>{few_substeps}));
    const std::vector<double> squares =
        gap::mean_squares(evidence.windows(), evidence.errors({}, gap::everything(evidence)));
    const double gap = gap::total_gap(gap::signal_gaps(evidence, squares, squares)).before;
    return std::sqrt(std::max(0.0, gap * gap - 1.0));
}

std::optional<SizedGap> size_for_gap(const std::function<double(double)>& gap_of, const SizeRange& sizes,
                                     const GapAim& aim) {
    constexpr int trials = 8;
    constexpr double near = 1.5, longest_step = 30.0;
    std::optional<double> too_small, too_large;
    std::optional<SizedGap> allowed;
    const auto miss = [&](double gap) { return std::abs(std::log(gap / aim.target)); };
    double size = std::min(sizes.start, sizes.largest);
    for (int trial = 0; trial < trials; ++trial) {
        const double gap = std::max(gap_of(size), aim.low / longest_step);
        const bool is_allowed = gap >= aim.low && gap <= aim.high;
        if (is_allowed && (!allowed || miss(gap) < miss(allowed->gap_floors))) allowed = SizedGap{size, gap};
        if (is_allowed && miss(gap) <= std::log(near)) break;
        (gap < aim.target ? too_small : too_large) = size;
        if (gap < aim.target && size >= sizes.largest) break;
        size = too_small && too_large
                   ? std::sqrt(*too_small * *too_large)
                   : std::min(sizes.largest,
                              size * std::clamp(aim.target / gap, 1.0 / longest_step, longest_step));
    }
    return allowed;
}

}  // namespace fidservo::selfcheck
