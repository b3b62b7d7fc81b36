// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/input.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/identify/column_units.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// Throws InputError, which asks for the unit, if no unit of time is stated and the rows are not as far apart
/// as a rig's ticks are in seconds. Units of time go by thousands: an interval within a factor of
/// sqrt(1000) of the tick is nearer to it in seconds than in any other of them.
void demand_plausible_seconds(const IdentifyInput& input, const std::vector<double>& times_s) {
    const TextTable& table = input.table.value();
    const TableColumn& time = *table.find("time");
    if (!time.unit.empty() || times_s.size() < 2) return;
    const double interval_s = (times_s.back() - times_s.front()) / static_cast<double>(times_s.size() - 1);
    const double nearest = std::sqrt(1000.0);
    if (interval_s > input.rig.tick_s / nearest && interval_s < input.rig.tick_s * nearest) return;
    throw InputError(fmt::format(
        "{0}: time: its unit is not stated, and rows {1:.4g} apart are hardly seconds: a tick of the rig {2} "
        "is {3:g} s; say it in --columns, as time={4}[UNIT] with one of {5}; rows that are only counted: "
        "--rate-hz in place of time",
        table.file.string(), interval_s, input.rig.name, input.rig.tick_s, time.column,
        fmt::join(units_of("time"), ", ")));
}

}  // namespace

std::vector<double> table_times_s(const IdentifyInput& input) {
    const TextTable& table = input.table.value();
    if (table.find("time") == nullptr) {
        FIDSERVO_DEMAND(input.table_rate_hz > 0.0);
        std::vector<double> times_s(table.rows());
        for (std::size_t k = 0; k < times_s.size(); ++k)
            times_s[k] = static_cast<double>(k) / input.table_rate_hz;
        return times_s;
    }
    std::vector<double> times_s = values_in(table, "time", "s");
    for (std::size_t k = 1; k < times_s.size(); ++k)
        if (times_s[k] <= times_s[k - 1])
            throw InputError(fmt::format("{}: row {}: time: {}: must be after the row before, {}",
                                         table.file.string(), k + 1, times_s[k], times_s[k - 1]));
    demand_plausible_seconds(input, times_s);
    return times_s;
}

void demand_every_tick(const Recording& recording) {
    constexpr double longest_ticks = 1.5;
    for (std::size_t k = 1; k < recording.rows.size(); ++k) {
        const double step_s = seconds(recording.rows[k].time_ns - recording.rows[k - 1].time_ns);
        if (step_s > longest_ticks * recording.tick_s)
            throw InputError(fmt::format(
                "{}: stage0/data.csv: {:.4g} s are missing at {:.4g} s: every tick is needed here",
                recording.name, step_s, seconds(recording.rows[k - 1].time_ns)));
    }
}

void demand_possible_readings(const Recording& recording, const HallParameters& hall) {
    const double highest = std::exp2(hall.adc_bits) - 1.0;
    for (const StageRow& row : recording.rows)
        if (row.hall_adc < 0.0 || row.hall_adc > highest)
            throw InputError(fmt::format("{}: stage0/data.csv: hall [adc]: {} at {:.4g} s: must be 0 to {}",
                                         recording.name, row.hall_adc, seconds(row.time_ns), highest));
}

Recording table_as_macro_recording(const IdentifyInput& input) {
    const TextTable& table = input.table.value();
    const std::vector<double> times_s = table_times_s(input);
    const std::vector<double> command_V = values_in(table, "input", "V");
    const std::vector<double> position_mm = values_in(table, "output", "mm");
    Recording recording;
    recording.name = table.file.filename().string();
    recording.rig = input.rig.name;
    recording.tick_s = times_s.size() < 2
                           ? input.rig.tick_s
                           : (times_s.back() - times_s.front()) / static_cast<double>(times_s.size() - 1);
    constexpr double longest_tick_s = 1.0;  // as of a rig file
    if (recording.tick_s > longest_tick_s)
        throw InputError(fmt::format(
            "{}: rows are {:.4g} s apart: the carriage's motion between them is not seen; allowed: {} s "
            "at most",
            table.file.string(), recording.tick_s, longest_tick_s));
    recording.columns.macro_command = recording.columns.position = true;
    recording.rows.resize(times_s.size());
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        constexpr double largest_jitter = 0.01;
        const double regular_s = times_s.front() + static_cast<double>(k) * recording.tick_s;
        if (std::abs(times_s[k] - regular_s) > largest_jitter * recording.tick_s)
            throw InputError(
                fmt::format("{}: row {}: time: {}: rows must be equally spaced; {:.9g} was expected",
                            table.file.string(), k + 1, times_s[k], regular_s));
        recording.rows[k].time_ns = nanoseconds(times_s[k] - times_s.front());
        recording.rows[k].macro_command_V = command_V[k];
        recording.rows[k].position_mm = position_mm[k];
    }
    return recording;
}

}  // namespace fidservo
