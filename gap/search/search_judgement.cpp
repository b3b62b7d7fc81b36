// SPDX-License-Identifier: GPL-3.0-or-later
// What an explanation leaves, and whether an effect that was added to it is to be accepted.
#include "gap/fit/gap_size.h"
#include "gap/numbers.h"
#include "gap/search/contender.h"
#include "gap/search/search.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <vector>

namespace fidservo::gap {
namespace {

/// An effect ties with the best one if it is behind by fewer standard deviations than this.
constexpr double effect_tie_significance = 2.0;

/// Share of the excess that a signal has before any effect: an effect has to remove as much if it does not
/// bring the signal to its floor.
constexpr double least_share_of_first = next_to_none;

SignalFlags above(const SignalExcess& excess, double bound) {
    SignalFlags flags{};
    for (std::size_t s = 0; s < signal_count; ++s) flags[s] = excess[s] > bound;
    return flags;
}

/// Numbers of far-off windows or tags that are no chance: in each half, or in one half and two recordings.
struct Enough {
    std::size_t of_each_half, of_one_half;
};

/// @param runs  for each half, the run of each window or tag that is far off
bool are_enough(const std::array<std::vector<std::size_t>, 2>& runs, const Enough& enough) {
    constexpr std::size_t fewest_runs = 2;
    return std::ranges::all_of(runs,
                               [&](const auto& of_half) { return of_half.size() >= enough.of_each_half; }) ||
           std::ranges::any_of(runs, [&](const auto& of_half) {
               return of_half.size() >= enough.of_one_half &&
                      std::set(of_half.begin(), of_half.end()).size() >= fewest_runs;
           });
}

}  // namespace

bool Search::is_significant(const Comparison& comparison, double times) const {
    return comparison.significance >
           times * significance_bound(comparison.blocks, std::max(trials_, 1), options_.tail);
}

bool Search::is_no_chance(const CrossFit& without, const CrossFit& with, double times) const {
    const Comparison comparison = fitter_.compared(without, with);
    return comparison.gain > least_gain && is_significant(comparison, times);
}

bool Search::is_real(const CrossFit& without, const CrossFit& with) const {
    constexpr double least_share = 0.3;
    const Comparison comparison = fitter_.compared(without, with);
    return clears_a_signal(without, with, least_share, least_share_of_first) &&
           comparison.gain > least_gain &&
           (is_significant(comparison) || clears_what_is_far_off(without, with));
}

bool Search::clears_what_is_far_off(const CrossFit& without, const CrossFit& with) const {
    // For tags a small excess may remain, since a rolling shutter leaves some shapes off when the stage
    // shakes. Unlike the carriage's motion, shapes do not depend on stick-slip.
    const SignalExcess before = fitter_.excess(without.mean_squares),
                       after = fitter_.excess(with.mean_squares);
    for (std::size_t s = 0; s < signal_count; ++s) {
        const auto signal = static_cast<Signal>(s);
        const double most_left = signal == Signal::tag ? least_share_of_first * before[s] : 0.0;
        if (before[s] > 0.0 && after[s] <= most_left && is_far_off(without, signal)) return true;
    }
    return false;
}

bool Search::is_far_off(const CrossFit& cross, Signal signal) const {
    // Least numbers of windows, and of shapes of tags.
    constexpr Enough windows_enough{3, 6}, shapes_enough{6, 12};
    std::array<std::vector<std::size_t>, 2> runs, runs_of_shapes;
    const std::vector<Window>& windows = fitter_.evidence().windows();
    for (const std::size_t side : {0, 1}) {
        const Wanted half = fitter_.half(side);
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (half[w] != 0 && windows[w].signal == signal && cross.mean_squares[w] > far_off_square)
                runs[side].push_back(windows[w].run);
        if (signal == Signal::tag) runs_of_shapes[side] = runs_of_shapes_far_off(cross, side);
    }
    return are_enough(runs, windows_enough) || are_enough(runs_of_shapes, shapes_enough);
}

std::vector<std::size_t> Search::runs_of_shapes_far_off(const CrossFit& cross, std::size_t side) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const Wanted wanted = only_of(windows, fitter_.half(side), only(Signal::tag));
    const Errors errors = fitter_.evidence().errors(cross.of_half[1 - side], wanted);
    std::vector<std::size_t> runs;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (wanted[w] == 0) continue;
        for (std::size_t tag = windows[w].begin; tag < windows[w].end; tag += corner_values) {
            const auto shape = std::span(errors).subspan(tag + 1, corner_values - 1);
            const double square = std::inner_product(shape.begin(), shape.end(), shape.begin(), 0.0);
            if (square > far_off_square * static_cast<double>(shape.size())) runs.push_back(windows[w].run);
        }
    }
    return runs;
}

bool Search::nearly_clears(const CrossFit& without, const CrossFit& with, double share) const {
    return clears_a_signal(without, with, share);
}

bool Search::clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                             double share_of_first) const {
    const SignalExcess before = fitter_.excess(without.mean_squares),
                       after = fitter_.excess(with.mean_squares);
    constexpr double near_floor = 0.5;
    for (std::size_t s = 0; s < signal_count; ++s) {
        const bool is_as_good_as_cleared = after[s] < near_floor && after[s] <= hardly_any * before[s];
        if (after[s] < (1.0 - share) * before[s] &&
            (is_as_good_as_cleared || before[s] - after[s] >= share_of_first * first_excess_[s]))
            return true;
    }
    return false;
}

SignalFlags Search::off(const CrossFit& fitted) const {
    return above(fitter_.excess(fitted.mean_squares), 0.0);
}

SignalFlags Search::far_off(const CrossFit& fitted, double floors) const {
    return above(fitter_.excess(fitted.mean_squares), floors * floors - 1.0);
}

std::optional<Signal> Search::furthest_off(const CrossFit& fitted) const {
    const SignalExcess excess = fitter_.excess(fitted.mean_squares);
    const auto most = std::ranges::max_element(excess);
    if (!(*most > 0.0)) return {};
    return static_cast<Signal>(most - excess.begin());
}

double Search::gap_alone(const plant::EffectSetting& setting) const {
    const Evidence& evidence = fitter_.evidence();
    const Wanted wanted = only_of(evidence.windows(), everything(evidence), reached_by({setting}));
    const Errors nothing = evidence.errors({}, wanted);
    Errors change = evidence.errors({setting}, wanted);
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= nothing[k];
    std::vector<double> squares = mean_squares(evidence.windows(), change);
    for (std::size_t w = 0; w < squares.size(); ++w) squares[w] = wanted[w] == 0 ? 1.0 : 1.0 + squares[w];
    return total_gap(signal_gaps(evidence, squares, squares)).after;
}

bool Search::is_at_floor(const CrossFit& fitted) const {
    return off(fitted) == SignalFlags{};
}

SignalFlags Search::leaves_much(const CrossFit& fitted) const {
    SignalExcess excess = fitter_.excess(fitted.mean_squares);
    for (std::size_t s = 0; s < signal_count; ++s) excess[s] -= least_share_of_first * first_excess_[s];
    return above(excess, 0.0);
}

bool Search::leaves_little(const CrossFit& fitted) const {
    return leaves_much(fitted) == SignalFlags{};
}

bool Search::ties(const CrossFit& best, const CrossFit& other) const {
    const Comparison lead = fitter_.compared(other, best);
    return lead.gain < least_gain || lead.significance < effect_tie_significance;
}

}  // namespace fidservo::gap
