#include "gap/held_carriage.h"

#include "core/dead_zone.h"
#include "gap/carriage_run.h"

#include <cmath>

namespace fidservo::gap {
namespace {

/// How often a carriage stands while it is pushed further than play explains.
int times_held(const Recording& recording, const MacroParameters& macro) {
    constexpr double play_mm = 1.0, from_ends_mm = 1.0;
    const double tick_s = recording.tick_s, tau_s = -tick_s / std::log(macro.velocity_pole);
    int times = 0;
    double stood_s = 0.0, lost_mm = 0.0, last_V = 0.0, last_count = 0.0;
    for (const StageRow& row : recording.rows) {
        const double push_V = dead_zone_V(macro.dead_zone, row.macro_command_V);
        const double count = reading_count(row, macro), place_mm = macro.encoder_resolution_mm * count;
        const bool stands = push_V * last_V > 0.0 && count == last_count &&
                            place_mm > macro.low_mm + from_ends_mm && place_mm < macro.high_mm - from_ends_mm;
        stood_s = stands ? stood_s + tick_s : 0.0;
        const double before_mm = stands ? lost_mm : 0.0;
        lost_mm = before_mm;
        if (stood_s > tau_s) lost_mm += macro.velocity_gain_mm_per_s_per_V * std::abs(push_V) * tick_s;
        if (before_mm <= play_mm && lost_mm > play_mm) ++times;
        last_V = push_V;
        last_count = count;
    }
    return times;
}

}  // namespace

bool carriage_is_held(const Evidence& evidence) {
    constexpr int fewest = 5;
    int times = 0;
    for (const Recording& recording : evidence.recordings())
        times += times_held(recording, evidence.rig().macro);
    return times >= fewest;
}

}  // namespace fidservo::gap
