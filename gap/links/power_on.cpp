// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/power_on.h"

#include "core/hall.h"
#include "core/median.h"
#include "core/rig.h"
#include "gap/evidence/plate_tag.h"
#include "gap/links/carriage_run.h"
#include "gap/links/controller_link.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace fidservo::gap {

namespace {

bool same_controllers(const Recording& a, const Recording& b) {
    if (a.controllers.has_value() != b.controllers.has_value()) return false;
    if (!a.controllers)
        return a.experiment == b.experiment || !(claims_controller(a) || claims_controller(b));
    return a.controllers->macro == b.controllers->macro && a.controllers->micro == b.controllers->micro;
}

bool goes_on(const Recording& before, const Recording& after, const Rig& rig) {
    if (before.rows.empty() || after.rows.empty() || before.rig != after.rig ||
        before.tick_s != after.tick_s || before.plate != after.plate || !same_controllers(before, after))
        return false;
    const double pause_s = seconds(after.rows.front().time_ns - before.rows.back().time_ns);
    if (pause_s <= 0.0 || pause_s > longest_pause_s) return false;
    const MacroParameters& macro = rig.macro;
    const double fastest_mm_per_s = macro.velocity_gain_mm_per_s_per_V * macro.command_limit_V;
    const double most_counts = 1.0 + pause_s * fastest_mm_per_s / macro.encoder_resolution_mm;
    const double way_counts =
        reading_count(after.rows.front(), macro) - reading_count(before.rows.back(), macro);
    return std::abs(way_counts) <= most_counts;
}

bool overlap(const Recording& a, const Recording& b) {
    return !a.rows.empty() && !b.rows.empty() && a.rows.front().time_ns <= b.rows.back().time_ns &&
           b.rows.front().time_ns <= a.rows.back().time_ns;
}

/// For each recording, whether another one covers some of the same time. Since a rig does one thing at a
/// time, their clocks then differ.
std::vector<bool> on_own_clocks(const std::vector<Recording>& recordings) {
    std::vector<bool> on_own(recordings.size(), false);
    for (std::size_t i = 0; i < recordings.size(); ++i)
        for (std::size_t k = i + 1; k < recordings.size(); ++k)
            if (overlap(recordings[i], recordings[k])) on_own[i] = on_own[k] = true;
    return on_own;
}

void append(Recording& run, Recording next) {
    const auto add = [](auto& to, auto&& from) {
        to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    };
    if (run.experiment != next.experiment) run.experiment = "run";
    if (next.encoder_zero &&
        (!run.encoder_zero || next.encoder_zero->std_count < run.encoder_zero->std_count))
        run.encoder_zero = std::move(next.encoder_zero);
    run.is_unfinished = next.is_unfinished;
    run.macro_setpoint_step_mm = std::max(run.macro_setpoint_step_mm, next.macro_setpoint_step_mm);
    add(run.events, std::move(next.events));
    add(run.rows, std::move(next.rows));
    add(run.detections, std::move(next.detections));
    add(run.frames, std::move(next.frames));
    add(run.appearances, std::move(next.appearances));
}

/// Position of the rig file's camera, mm, from which it sees a tag where it was detected; empty for a tag
/// that the plate does not have.
std::optional<double> camera_place_mm(const Recording& recording, const TagDetection& detection,
                                      const Rig& rig) {
    const auto tag = plate_tag(recording, rig, detection.tag_id);
    if (!tag) return std::nullopt;
    Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner_px : detection.corners_px) middle_px += corner_share * corner_px;
    double s_mm = tag->centre_mm.x();
    constexpr int rounds = 3;  // with an oblique axis the distance changes on the way
    for (int round = 0; round < rounds; ++round)
        s_mm += tag->centre_mm.x() - back_project(rig.camera->geometry, middle_px, s_mm).x();
    return s_mm;
}

/// What a detection tells of the encoder's zero.
struct SeenPlace {
    double read_mm;    ///< position of the carriage by its count
    double offset_mm;  ///< camera's position by the tag, minus that by the readings
};

std::vector<SeenPlace> seen_places(const Recording& recording, const Rig& rig) {
    std::vector<SeenPlace> places;
    if (recording.rows.empty()) return places;
    for (const TagDetection& detection : recording.detections) {
        const auto seen_mm = camera_place_mm(recording, detection, rig);
        if (!seen_mm) continue;
        const StageRow& row = recording.rows[row_at(recording.rows, detection.time_ns)];
        const double read_mm = rig.macro.encoder_resolution_mm * reading_count(row, rig.macro);
        const double platform_mm = rig.micro ? hall_position_mm_of_adc(rig.micro->hall, row.hall_adc) : 0.0;
        const double offset_mm = *seen_mm - read_mm - platform_mm;
        if (std::isfinite(offset_mm)) places.push_back({read_mm, offset_mm});
    }
    return places;
}

SeenPlace median_place(std::span<const SeenPlace> places) {
    std::vector<double> read_mm, offset_mm;
    for (const SeenPlace& place : places) {
        read_mm.push_back(place.read_mm);
        offset_mm.push_back(place.offset_mm);
    }
    return {median_of(std::move(read_mm)), median_of(std::move(offset_mm))};
}

/// The offset at count 0. With a wrong scale of the encoder offsets grow with the position: then by a line
/// through the medians of the lower and the upper third of the positions, if these are far enough apart.
double offset_at_zero_mm(std::vector<SeenPlace> places) {
    constexpr double far_mm = 20.0;
    std::ranges::sort(places, {}, &SeenPlace::read_mm);
    // Mathematics: a third, rounded up.
    const std::size_t third = (places.size() + 2) / 3;
    const SeenPlace low = median_place(std::span(places).first(third));
    const SeenPlace high = median_place(std::span(places).last(third));
    if (high.read_mm - low.read_mm < far_mm) return median_place(places).offset_mm;
    const double per_mm = (high.offset_mm - low.offset_mm) / (high.read_mm - low.read_mm);
    return low.offset_mm - per_mm * low.read_mm;
}

/// Whether all readings lie in the travel that the rig file states, with a margin at the far end for an
/// encoder with a wrong scale.
bool lies_in_travel(const Recording& recording, const MacroParameters& macro) {
    constexpr double most_off = 0.05;
    const double lowest_mm = macro.low_mm - margin_mm;
    const double highest_mm = macro.high_mm + margin_mm + most_off * (macro.high_mm - macro.low_mm);
    return std::ranges::all_of(readings_mm(recording, macro), [&](double place_mm) {
        return !(place_mm < lowest_mm || place_mm > highest_mm);
    });
}

void shift(Recording& recording, double counts, double resolution_mm) {
    for (StageRow& row : recording.rows) {
        row.encoder_count += counts;
        row.position_mm += counts * resolution_mm;
    }
}

}  // namespace

std::vector<Recording> joined(std::vector<Recording> recordings, const Rig& rig) {
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> next(recordings.size(), none);
    std::vector<bool> is_continued(recordings.size(), false);  // it continues another one
    const std::vector<bool> is_apart = on_own_clocks(recordings);
    for (std::size_t i = 0; i < recordings.size(); ++i)
        for (std::size_t k = 0; k < recordings.size() && next[i] == none; ++k)
            if (!is_apart[i] && !is_apart[k] && !is_continued[k] &&
                goes_on(recordings[i], recordings[k], rig)) {
                next[i] = k;
                is_continued[k] = true;
            }
    std::vector<Recording> runs;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        if (is_continued[i]) continue;
        std::string last_name;
        runs.push_back(std::move(recordings[i]));
        for (std::size_t k = next[i]; k != none; k = next[k]) {
            last_name = recordings[k].name;
            append(runs.back(), std::move(recordings[k]));
        }
        if (!last_name.empty()) runs.back().name += " to " + last_name;
    }
    return runs;
}

PlacesFrom refer_to_travel(Recording& recording, const Rig& rig) {
    constexpr double sure_counts = 0.5;
    const double resolution_mm = rig.macro.encoder_resolution_mm;
    std::vector<SeenPlace> places;
    if (shows_tags(recording, rig)) places = seen_places(recording, rig);
    if (recording.encoder_zero && recording.encoder_zero->std_count <= sure_counts) {
        shift(recording, -std::round(recording.encoder_zero->count), resolution_mm);
        const bool is_measured = recording.encoder_zero->std_count > 0.0;
        return is_measured && !places.empty() ? PlacesFrom::tags : PlacesFrom::recording;
    }
    const bool in_travel = lies_in_travel(recording, rig.macro);
    if (places.empty()) return in_travel ? PlacesFrom::recording : PlacesFrom::nowhere;
    if (in_travel && std::abs(offset_at_zero_mm(places)) <= margin_mm) return PlacesFrom::recording;
    shift(recording, std::round(median_place(places).offset_mm / resolution_mm), resolution_mm);
    return PlacesFrom::tags;
}

}  // namespace fidservo::gap
