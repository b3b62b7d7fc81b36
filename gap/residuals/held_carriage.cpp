// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/held_carriage.h"

#include "core/dead_zone.h"
#include "core/rig.h"
#include "gap/links/carriage_run.h"
#include "gap/numbers.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace fidservo::gap {
namespace {

/// The ways, in mm, by which a carriage that stands is pushed on, of those that are longer than play
/// explains.
std::vector<double> ways_lost_mm(const Recording& recording, const MacroParameters& macro) {
    constexpr double play_mm = 1.0;
    constexpr double edge_V = 0.05;  // any small force holds a carriage that hardly pushes
    const double tick_s = recording.tick_s, tau_s = time_constant_s(macro, tick_s);
    std::vector<double> ways_mm;
    double stood_s = 0.0, lost_mm = 0.0, last_V = 0.0, last_count = 0.0;
    for (const StageRow& row : recording.rows) {
        const double push_V = dead_zone_V(macro.dead_zone, row.macro_command_V);
        const double count = reading_count(row, macro), place_mm = macro.encoder_resolution_mm * count;
        const bool stands = push_V * last_V > 0.0 && count == last_count &&
                            place_mm > macro.low_mm + margin_mm && place_mm < macro.high_mm - margin_mm;
        stood_s = stands ? stood_s + tick_s : 0.0;
        const double before_mm = stands ? lost_mm : 0.0;
        lost_mm = before_mm;
        const DeadZoneBranch branch = dead_zone_branch(macro.dead_zone, row.macro_command_V);
        const bool is_clear = dead_zone_slack_V(macro.dead_zone, branch, row.macro_command_V) > edge_V;
        if (stood_s > tau_s && is_clear)
            lost_mm += macro.velocity_gain_mm_per_s_per_V * std::abs(push_V) * tick_s;
        if (before_mm <= play_mm && lost_mm > play_mm) ways_mm.push_back(lost_mm);
        if (before_mm > play_mm) ways_mm.back() = lost_mm;
        last_V = push_V;
        last_count = count;
    }
    return ways_mm;
}

}  // namespace

bool carriage_is_held(const Evidence& evidence) {
    constexpr std::size_t fewest = 2;
    constexpr double least_mm = 5.0;
    std::size_t times = 0;
    double sum_mm = 0.0;
    for (const Recording& recording : evidence.recordings())
        for (const double way_mm : ways_lost_mm(recording, evidence.rig().macro)) {
            ++times;
            sum_mm += way_mm;
        }
    return times >= fewest && sum_mm > least_mm;
}

}  // namespace fidservo::gap
