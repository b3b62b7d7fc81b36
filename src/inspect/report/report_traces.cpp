// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/report_traces.h"

#include "core/hall.h"
#include "core/rig.h"
#include "core/time.h"
#include "src/files/recording/reader.h"
#include "src/inspect/report/report_sections.h"
#include "src/report/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

std::string kind_of(const Visit& visit) {
    const report::Mood mood =
        visit.end == Visit::End::deferred ? report::Mood::unsure : mood_of(outcome_of(visit));
    return std::string(report::class_of(mood));
}

float platform_mm(const Rig& rig, const StageRow& row) {
    if (!rig.micro || !std::isfinite(row.hall_adc)) return static_cast<float>(not_in_force);
    return static_cast<float>(hall_position_mm_of_adc(rig.micro->hall, row.hall_adc));
}

/// The encoder is incremental: its count at the end stop, the lowest while homing, stands for the low end of
/// the travel.
double encoder_zero_mm(const OutputFolder& output, const Rig& rig) {
    const std::filesystem::path homing = output.root / "recordings/homing";
    if (!std::filesystem::exists(homing)) return 0.0;
    double lowest = std::numeric_limits<double>::infinity();
    for (const StageRow& row : read_recording(homing).rows)
        if (std::isfinite(row.encoder_count)) lowest = std::min(lowest, row.encoder_count);
    return std::isfinite(lowest) ? rig.macro.low_mm - lowest * rig.macro.encoder_resolution_mm : 0.0;
}

}  // namespace

std::string traces_html(const OutputFolder& output, const Rig& rig, const std::vector<Visit>& visits,
                        std::size_t most_points) {
    std::vector<StageRow> rows;
    report::TimeAxis axis;
    for (const Visit& visit : visits) {
        if (!std::filesystem::exists(output.root / visit.recording)) continue;
        const Recording recording = read_recording(output.root / visit.recording);
        rows.insert(rows.end(), recording.rows.begin(), recording.rows.end());
        axis.spans.push_back({visit.from_s, visit.to_s, std::to_string(visit.site), kind_of(visit)});
    }
    if (rows.empty()) return "<p>There are no recordings.</p>";

    std::vector<float> platform;
    platform.reserve(rows.size());
    for (const StageRow& row : rows) platform.push_back(platform_mm(rig, row));
    const double zero_mm = encoder_zero_mm(output, rig);
    const bool measured = rig.micro.has_value();
    std::vector<float> guide = platform;
    if (!measured)
        for (std::size_t i = 0; i < rows.size(); ++i) guide[i] = static_cast<float>(rows[i].encoder_count);
    report::Trace setpoint{"set point", {}, true, 3, true},
        carriage{"carriage (encoder)", {}, false, 2, false};
    report::Trace goal{"set point", {}, true, 4, true},
        position{"platform (Hall sensor)", {}, false, 4, false};
    report::Trace motor{"motor", {}, true, 3, false}, heater{"heater", {}, true, 3, false};
    for (const std::size_t i : report::envelope_rows(guide, most_points)) {
        axis.time_s.push_back(seconds(rows[i].time_ns));
        setpoint.values.push_back(static_cast<float>(rows[i].macro_setpoint_mm));
        carriage.values.push_back(
            static_cast<float>(zero_mm + rows[i].encoder_count * rig.macro.encoder_resolution_mm));
        goal.values.push_back(static_cast<float>(rows[i].micro_setpoint_mm));
        position.values.push_back(platform[i]);
        motor.values.push_back(static_cast<float>(rows[i].macro_command_V));
        heater.values.push_back(static_cast<float>(rows[i].micro_command_V));
    }
    std::vector<report::TimePlot> plots{{"macro", "Macro stage", "mm", "stage", 220, {setpoint, carriage}}};
    if (measured) plots.push_back({"micro", "Micro stage", "mm", "stage", 220, {goal, position}});
    plots.push_back({"commands", "Commands", "V", "stage", 160, {motor, heater}});
    return report::time_plots(axis, plots) +
           fmt::format(
               "<p class=\"hint\">{} of {} recorded ticks are shown; the recordings have them all.</p>\n",
               axis.time_s.size(), rows.size());
}

}  // namespace fidservo::inspect
