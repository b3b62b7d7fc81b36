// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence_parts.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/evidence/clear_detections.h"
#include "gap/evidence/noise_floor.h"
#include "gap/evidence/plate_tag.h"
#include "gap/links/wire_memory.h"
#include "gap/links/wire_start.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

namespace fidservo::gap {

namespace {

/// Motion and temperature along a recording, by the rig file's model.
Course course_of(const Rig& rig, const RunLinks& links, const PlatformPrediction* platform) {
    Course course;
    const std::size_t rows = links.carriage.command_V.size();
    course.position_mm.assign(links.path.position_mm.begin(), links.path.position_mm.end());
    course.velocity_mm_per_s.assign(links.path.velocity_mm_per_s.begin(), links.path.velocity_mm_per_s.end());
    course.temperature_degC.assign(rows, std::numeric_limits<float>::quiet_NaN());
    course.contraction_mm = course.temperature_degC;
    if (platform == nullptr) return course;
    course.temperature_degC.assign(platform->temperature_degC.begin(), platform->temperature_degC.end());
    const HallParameters& hall = rig.micro->hall;
    for (std::size_t k = 0; k < rows; ++k)
        course.contraction_mm[k] =
            static_cast<float>(hall_position_mm_of_adc(hall, links.smoothed->reading_lsb[k]));
    return course;
}

/// Appends a recording's windows of one signal.
/// @param expected_square  mean square of a window's errors under the truth, floors^2
void add_windows(
    Evidence::Parts& parts, std::size_t run, Signal signal, const std::vector<WindowRows>& all,
    const std::function<double(const WindowRows&)>& expected_square = [](const WindowRows&) { return 1.0; }) {
    for (const WindowRows& window : all) {
        const std::size_t rows = window.end - window.first;
        parts.windows.push_back({run, signal, parts.recordings[run].rows[window.first].time_ns, window.first,
                                 rows, parts.values, parts.values + rows});
        parts.windows.back().expected_square = expected_square(window);
        parts.values += rows;
    }
}

/// Share of a window's rows in which the carriage's reading changes (CarriageRun::stands is false); at least
/// 0.05, as a reading may flicker between two counts.
double moving_share(const CarriageRun& run, const WindowRows& window) {
    std::size_t moving = 0;
    for (std::size_t k = window.first; k < window.end; ++k) moving += run.stands[k] ? 0 : 1;
    constexpr double least = 0.05;
    return std::max(least, static_cast<double>(moving) / static_cast<double>(window.end - window.first));
}

void add_tag_windows(Evidence::Parts& parts, std::size_t run) {
    for (const TagWindow& window : parts.links[run].tags.windows) {
        const std::size_t values = corner_values * (window.end - window.first);
        parts.windows.push_back({run, Signal::tag, parts.recordings[run].rows[window.rows.first].time_ns,
                                 window.rows.first, window.rows.end - window.rows.first, parts.values,
                                 parts.values + values, window.first});
        parts.values += values;
    }
}

void add_image_windows(Evidence::Parts& parts, std::size_t run) {
    for (const ImageWindow& window : parts.images[run].windows) {
        const std::size_t values = image_values * (window.end - window.first);
        parts.windows.push_back({run, Signal::image, parts.recordings[run].rows[window.first_row].time_ns,
                                 window.first_row, window.end_row - window.first_row, parts.values,
                                 parts.values + values, window.first, window.expected_square});
        parts.values += values;
    }
}

/// Notes how much of a signal that was recorded is not judged.
void note_rows(Evidence::Parts& parts, std::size_t run, std::string_view signal, std::size_t recorded,
               const std::vector<WindowRows>& windows, std::string_view why) {
    constexpr double worth_telling_s = 0.5;
    const double tick_s = parts.rig.tick_s;
    std::size_t judged = 0;
    for (const WindowRows& window : windows) judged += window.end - window.first;
    const double left_out_s = static_cast<double>(recorded - std::min(judged, recorded)) * tick_s;
    if (judged > 0 && left_out_s < worth_telling_s) return;
    if (recorded == 0) return;
    parts.omissions.push_back({parts.recordings[run].name, std::string(signal), std::string(why), left_out_s,
                               static_cast<double>(recorded) * tick_s});
}

template <class Has>
std::size_t count_rows(const Recording& recording, Has has) {
    return static_cast<std::size_t>(std::ranges::count_if(recording.rows, has));
}

void note_late_ticks(Evidence::Parts& parts, std::size_t run) {
    constexpr double worth_telling = 0.01;
    const LateTicks& late = parts.late[run];
    const auto recorded = static_cast<double>(std::ranges::count(late.is_filled, false));
    const double share = static_cast<double>(late.left_out) / (recorded + static_cast<double>(late.left_out));
    if (!(share > worth_telling)) return;
    parts.omissions.push_back(
        {parts.recordings[run].name, "rows",
         fmt::format(
             "the loop left out {:.0f} % of its ticks; where that was more than two at a time, nothing "
             "is judged",
             percent * share)});
}

void note_omissions(Evidence::Parts& parts, std::size_t run) {
    note_late_ticks(parts, run);
    const Recording& recording = parts.recordings[run];
    const RunLinks& links = parts.links[run];
    std::vector<WindowRows> carriage;
    for (const auto& windows : links.carriage.windows)
        carriage.insert(carriage.end(), windows.begin(), windows.end());
    note_rows(parts, run, "encoder",
              static_cast<std::size_t>(std::ranges::count_if(
                  links.carriage.reading_count, [](double count) { return std::isfinite(count); })),
              carriage, "ends of travel, gaps, or rows without a command");
    if (links.platform)
        note_rows(
            parts, run, "hall",
            count_rows(recording, [](const StageRow& row) { return std::isfinite(row.hall_adc); }),
            links.platform->windows,
            fmt::format("readings at an end of the range ({:.0f} or {:.0f}), gaps and the wire's unknown "
                        "memory after them, or rows without a command",
                        parts.hall_range.low_adc, parts.hall_range.high_adc));
    if (!recording.detections.empty() && !shows_tags(recording, parts.rig))
        parts.omissions.push_back({recording.name, "tag", "the rig file has no camera or no fiducials"});
    const auto unknown = std::ranges::count_if(
        links.tags.sightings, [](const TagSighting& sighting) { return !sighting.is_known; });
    if (unknown > 0)
        parts.omissions.push_back(
            {recording.name, "tag",
             fmt::format("{} detections are of tags that the plate does not have", unknown)});
    const auto controlled = [&](double StageRow::*setpoint) {
        return count_rows(recording, [&](const StageRow& row) { return std::isfinite(row.*setpoint); });
    };
    note_rows(parts, run, "macro_command", controlled(&StageRow::macro_setpoint_mm), links.macro.windows,
              "the commands are given: the recording does not say that a controller of the rig file made "
              "them, or rows lack a command or a count");
    note_rows(parts, run, "micro_command", controlled(&StageRow::micro_setpoint_mm), links.micro.windows,
              "the commands are given: the recording does not say that a controller of the rig file made "
              "them, or rows lack a command or a reading");
}

void drop_unclear_detections(Evidence::Parts& parts, std::size_t run) {
    constexpr double worth_telling = hardly_any;  // share of all detections
    Recording& recording = parts.recordings[run];
    const auto all = static_cast<double>(recording.detections.size());
    drop_unclear(recording, parts.links[run].path.velocity_mm_per_s, parts.rig,
                 recording.appearances.empty() ? parts.rig.camera->exposure_s : parts.shutter.exposure_s,
                 parts.smeared[run]);
    if (all - static_cast<double>(recording.detections.size()) > worth_telling * all)
        parts.omissions.push_back(
            {recording.name, "tag",
             "detections that are smeared, alone, at the image's border or not refined are not judged"});
}

}  // namespace

void check(const Rig& rig, const Recording& recording) {
    constexpr double same_tick = 1e-6;
    if (!recording.rows.empty() && std::abs(recording.tick_s - rig.tick_s) > same_tick * rig.tick_s)
        throw InputError(
            fmt::format("{}: tick_s {} is not the rig's {}", recording.name, recording.tick_s, rig.tick_s));
    if (!rig.micro && recording.columns.hall)
        throw InputError(recording.name + ": hall [adc]: the rig has no micro stage");
}

void find_noise(Evidence::Parts& parts) {
    if (parts.rig.micro) parts.hall_range = hall_range(parts.recordings, parts.rig.micro->hall);
    std::vector<QuietStretch> encoder, hall;
    const auto add = [](std::vector<QuietStretch>& to, const std::vector<QuietStretch>& found) {
        to.insert(to.end(), found.begin(), found.end());
    };
    for (const Recording& recording : parts.recordings) {
        std::vector<double> count, macro_V, adc, micro_V;
        for (const StageRow& row : recording.rows) {
            count.push_back(reading_count(row, parts.rig.macro));
            macro_V.push_back(row.macro_command_V);
            adc.push_back(within(parts.hall_range, row.hall_adc));
            micro_V.push_back(row.micro_command_V);
        }
        add(encoder, quiet_stretches(count, macro_V));
        add(hall, quiet_stretches(adc, micro_V));
    }
    parts.floors[index_of(Signal::encoder)] = floor_of(noise_before_rounding(encoder).value_or(0.0));
    if (parts.rig.micro)
        parts.floors[index_of(Signal::hall)] =
            floor_of(noise_before_rounding(hall).value_or(parts.rig.micro->hall.noise_lsb));
    if (!parts.rig.camera) return;
    // Errors of the detector that are the same in every frame (optics, print, unequal gains of the pixels) do
    // not show in the noise from frame to frame.
    constexpr double detector_px = 0.01;
    const CameraParameters& camera = *parts.rig.camera;
    parts.floors[index_of(Signal::tag)] = std::max(
        detector_px,
        corner_noise_px(parts.recordings, 1.0 / camera.frame_rate_hz).value_or(camera.corner_noise_px));
    const bool has_frames = std::ranges::any_of(
        parts.recordings, [](const Recording& recording) { return !recording.appearances.empty(); });
    if (has_frames)
        parts.floors[index_of(Signal::tag)] = std::hypot(parts.floors[index_of(Signal::tag)], detector_px);
}

void find_looks(Evidence::Parts& parts) {
    parts.images.resize(parts.recordings.size());
    parts.smeared.resize(parts.recordings.size());
    if (std::ranges::none_of(parts.recordings,
                             [&](const Recording& recording) { return shows_tags(recording, parts.rig); }))
        return;
    const CameraParameters& camera = *parts.rig.camera;
    for (std::size_t run = 0; run < parts.recordings.size(); ++run) {
        parts.budget->check();
        parts.smeared[run] = smeared_tags(parts.recordings[run]);
        parts.images[run] = image_run(parts.recordings[run], camera);
    }
    parts.shutter = seen_shutter(parts.recordings, parts.images, camera);
}

void find_wires(Evidence::Parts& parts) {
    parts.links.resize(parts.recordings.size());
    if (!parts.rig.micro) return;
    const PlatformModel stage = platform_model(plant::plant_parameters(parts.rig));
    std::vector<const PlatformRun*> runs;
    for (std::size_t run = 0; run < parts.recordings.size(); ++run) {
        PlatformRun& platform = parts.links[run].platform.emplace(platform_run(
            parts.recordings[run], *parts.rig.micro, parts.hall_range, parts.floors[index_of(Signal::hall)]));
        platform.budget = parts.budget;
        runs.push_back(&platform);
    }
    const double zero_lsb = zero_of_sensor_lsb(stage, runs);
    for (RunLinks& links : parts.links) {
        parts.budget->check();
        links.platform->start = wire_start(stage, *links.platform, zero_lsb);
        keep_known_memory(*links.platform, stage);
    }
}

void add_run(Evidence::Parts& parts, std::size_t run) {
    const Recording& recording = parts.recordings[run];
    const Rig& rig = parts.rig;
    const plant::PlantParameters nominal = plant::plant_parameters(rig);
    RunLinks& links = parts.links[run];
    links.carriage = carriage_run(recording, rig.macro, parts.places[run] != PlacesFrom::nowhere);
    links.carriage.budget = parts.budget;
    predicted_counts(carriage_model(nominal), links.carriage, links.path);
    if (shows_tags(recording, rig) && recording.is_seen && !recording.rows.empty())
        drop_unclear_detections(parts, run);
    std::optional<PlatformPrediction> platform;
    if (rig.micro) {
        const PlatformModel stage = platform_model(nominal);
        const FinerStage finer = finer_stage(nominal);
        platform = predicted_readings(stage, *links.platform, nullptr, &finer);
        links.smoothed = smoothed_reading(*links.platform, *platform, rig.macro.command_limit_V);
        links.smoothed->wire_degC = platform->temperature_degC;
    }
    if (shows_tags(recording, rig))
        links.tags =
            tag_run(recording, rig, links.path, links.carriage, links.platform ? &*links.platform : nullptr,
                    links.smoothed ? &*links.smoothed : nullptr,
                    {parts.floors[index_of(Signal::tag)], parts.shutter.readout_s});
    links.tags.zero_is_seen = parts.places[run] == PlacesFrom::tags;
    links.macro = macro_controller_run(recording, rig, parts.late[run].is_filled);
    links.micro = micro_controller_run(recording, rig, parts.late[run].is_filled);
    parts.courses.push_back(course_of(rig, links, platform ? &*platform : nullptr));

    parts.first_window.push_back(parts.windows.size());
    for (const auto& windows : links.carriage.windows)
        add_windows(parts, run, Signal::encoder, windows,
                    [&](const WindowRows& window) { return moving_share(links.carriage, window); });
    if (links.platform) add_windows(parts, run, Signal::hall, links.platform->windows);
    add_tag_windows(parts, run);
    add_windows(parts, run, Signal::macro_command, links.macro.windows);
    add_windows(parts, run, Signal::micro_command, links.micro.windows);
    add_image_windows(parts, run);
    note_omissions(parts, run);
}

}  // namespace fidservo::gap
