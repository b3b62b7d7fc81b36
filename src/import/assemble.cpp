// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/assemble.h"

#include "core/input_error.h"
#include "src/files/rig/plate_file.h"
#include "src/import/resample.h"
#include "src/import/signal_times.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

constexpr double same_rate = 0.01;
constexpr std::uint64_t most_rows = std::uint64_t{1} << 26U;

/// A column of the stage, from its signal.
struct ColumnSignal {
    std::size_t column;  ///< of stage_columns
    std::string name;
    TimedSignal signal;
    bool is_held;
};

/// A tenth of a per cent beside a number of three digits is taken for that number.
double rounded_tick_s(TimeNs interval_ns) {
    const double tick_s = seconds(interval_ns);
    const double digit = std::pow(10.0, std::floor(std::log10(tick_s)) - 2.0);
    const double round_s = std::round(tick_s / digit) * digit;
    return std::abs(round_s - tick_s) < 1e-3 * tick_s
               ? std::strtod(fmt::format("{:.3g}", round_s).c_str(), nullptr)
               : tick_s;
}

std::vector<ColumnSignal> column_signals(SignalSource& source, const ImportMap& map, Assembled& made) {
    std::vector<ColumnSignal> all;
    for (std::size_t k = 0; k < stage_columns.size(); ++k) {
        const std::string name(name_of_title(stage_columns[k].title));
        const auto choice = map.columns.find(name);
        if (choice == map.columns.end()) continue;
        const bool is_command = name.ends_with("_command") || name.ends_with("_setpoint");
        TimedSignal signal = source.timed(choice->second, unit_of_title(stage_columns[k].title));
        const bool is_as_logged =
            signal.values.size() == signal.signal->values.size() &&
            std::ranges::equal(signal.values, signal.signal->values,
                               [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
        if (is_as_logged) made.decimals[k] = choice->second.decimals.value_or(signal.signal->decimals);
        all.push_back({k, name, std::move(signal), choice->second.is_held.value_or(is_command)});
        made.recording.columns.*stage_columns[k].present = true;
    }
    return all;
}

bool have_same_times(const std::vector<ColumnSignal>& columns) {
    return std::ranges::all_of(columns, [&](const ColumnSignal& column) {
        return column.signal.time_ns == columns.front().signal.time_ns;
    });
}

std::string rate_text(TimeNs interval_ns) {
    return interval_ns == 0 ? std::string("one sample")
                            : fmt::format("{:.6g} Hz", 1e9 / static_cast<double>(interval_ns));
}

void take_rows(const std::vector<ColumnSignal>& columns, Assembled& made) {
    std::vector<StageRow>& rows = made.recording.rows;
    rows.resize(columns.front().signal.time_ns.size());
    for (std::size_t row = 0; row < rows.size(); ++row)
        rows[row].time_ns = columns.front().signal.time_ns[row];
    for (const ColumnSignal& column : columns) {
        for (std::size_t row = 0; row < rows.size(); ++row)
            rows[row].*stage_columns[column.column].value = column.signal.values[row];
        made.notes.push_back(fmt::format("{}: {} of {}, {} samples at {}, as they are", column.name,
                                         column.signal.signal->name, column.signal.log->file.string(),
                                         rows.size(), rate_text(median_interval(column.signal.time_ns))));
    }
}

void say_resampled(const ColumnSignal& column, double tick_s, Assembled& made) {
    const TimeNs interval = median_interval(column.signal.time_ns);
    const double ratio = tick_s / std::max(1e-9, seconds(interval));
    made.notes.push_back(
        fmt::format("{}: {} of {}, {} samples at {}, resampled to {:.6g} Hz: {}{}", column.name,
                    column.signal.signal->name, column.signal.log->file.string(), column.signal.values.size(),
                    rate_text(interval), 1.0 / tick_s,
                    column.is_held ? "held from sample to sample" : "on lines between samples",
                    !column.is_held && ratio > gap_in_intervals
                        ? fmt::format("; {:.3g} samples a row, faster motion is not filtered out", ratio)
                        : ""));
}

void make_rows(const std::vector<ColumnSignal>& columns, Assembled& made) {
    TimeNs first = INT64_MIN, last = INT64_MAX;
    for (const ColumnSignal& column : columns) {
        first = std::max(first, column.signal.time_ns.front());
        last = std::min(last, column.signal.time_ns.back());
    }
    if (last <= first)
        throw InputError(fmt::format(
            "{}: the signals share no time: the last to begin does so {:.6g} s after the first has ended; a "
            "clock needs offset_s or fit",
            columns.front().signal.log->file.string(), seconds(first - last)));
    const double tick_s = made.recording.tick_s;
    const double count = std::floor(seconds(last - first) / tick_s + 1e-6) + 1.0;
    if (count > static_cast<double>(most_rows))
        throw InputError(fmt::format("{}: {:.0f} rows of {} s: at most {} are made",
                                     columns.front().signal.log->file.string(), count, tick_s, most_rows));
    std::vector<Resampler> resamplers;
    for (const ColumnSignal& column : columns) {
        resamplers.emplace_back(column.signal.time_ns, column.signal.values,
                                column.is_held ? Between::hold : Between::line);
        made.decimals[column.column] = -1;
        say_resampled(column, tick_s, made);
    }
    std::size_t left_out = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        StageRow row;
        row.time_ns = std::min(last, first + nanoseconds(static_cast<double>(k) * tick_s));
        bool is_in_gap = false;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const RowValue value = resamplers[c].at(row.time_ns);
            row.*stage_columns[columns[c].column].value = value.value;
            is_in_gap = is_in_gap || value.is_in_gap;
        }
        if (is_in_gap)
            ++left_out;
        else
            made.recording.rows.push_back(row);
    }
    if (left_out > 0)
        made.notes.push_back(
            fmt::format("{} of {:.0f} rows left out: a reading has no sample near them", left_out, count));
}

void demand_measured(const Recording& recording, const ImportMap& map) {
    const StageColumns& has = recording.columns;
    if (!has.encoder && !has.position && !has.hall)
        throw InputError(fmt::format(
            "{}: columns: encoder, position or hall is missing: nothing was measured", map.file.string()));
}

void add_stage(SignalSource& source, const ImportMap& map, Assembled& made) {
    const std::vector<ColumnSignal> columns = column_signals(source, map, made);
    if (columns.empty()) return;
    demand_measured(made.recording, map);
    const std::vector<TimeNs>& times = columns.front().signal.time_ns;
    const TimeNs interval = median_interval(times);
    if (interval == 0 && made.recording.tick_s == 0.0)
        throw InputError(
            fmt::format("{}: recording.tick_s: missing, and one sample has no rate", map.file.string()));
    if (made.recording.tick_s == 0.0) {
        made.recording.tick_s = rounded_tick_s(interval);
        made.notes.push_back(
            fmt::format("tick_s: {}, from the times of {}", made.recording.tick_s, columns.front().name));
    }
    const double off = std::abs(seconds(interval) - made.recording.tick_s);
    if (made.recording.tick_s > 1.0)
        throw InputError(fmt::format("{}: a tick of {} s: at most 1 s is allowed", map.file.string(),
                                     made.recording.tick_s));
    if (have_same_times(columns) && (interval == 0 || off <= same_rate * made.recording.tick_s))
        take_rows(columns, made);
    else
        make_rows(columns, made);
}

void add_detections(SignalSource& source, const ImportMap& map, Assembled& made) {
    if (map.detections.empty()) return;
    std::map<std::string, TimedSignal> signals;
    for (const auto& [name, choice] : map.detections) {
        const std::string_view unit = name == "tag_id" || name == refined_title ? ""
                                      : name.size() > 4                         ? "px^2"
                                                                                : "px";
        signals[name] = source.timed(choice, unit, true);
    }
    const TimedSignal& ids = signals.at("tag_id");
    for (const auto& [name, signal] : signals)
        if (signal.time_ns != ids.time_ns)
            map.detections.at(name).where->fail(fmt::format("{}: has other times than tag_id", name));
    const auto value = [&](std::string_view title, std::size_t row) {
        return signals.at(std::string(name_of_title(title))).values[row];
    };
    const bool has_covariances = signals.contains("p0_xx"),
               has_refined = signals.contains(std::string(refined_title));
    for (std::size_t row = 0; row < ids.values.size(); ++row) {
        TagDetection tag;
        tag.time_ns = ids.time_ns[row];
        constexpr double most_id = 1e6;
        const double id = ids.values[row];
        if (!(id >= 0.0 && id <= most_id) || id != std::floor(id))
            throw InputError(fmt::format("{}: {}: value {}: {} is no tag's number", ids.log->file.string(),
                                         ids.signal->name, row + 1, id));
        tag.tag_id = static_cast<int>(id);
        for (std::size_t k = 0; k < 4; ++k)
            tag.corners_px[k] = {value(corner_titles[2 * k], row), value(corner_titles[2 * k + 1], row)};
        if (std::ranges::any_of(tag.corners_px, [](const auto& corner) { return !corner.allFinite(); }))
            throw InputError(
                fmt::format("{}: the detection {} lacks a corner", ids.log->file.string(), row + 1));
        if (has_refined && !std::isnan(value(refined_title, row)))
            tag.is_refined = value(refined_title, row) != 0.0;
        if (has_covariances && !std::isnan(value(covariance_titles.front(), row))) {
            CornerCovariances covariances;
            for (std::size_t k = 0; k < 4; ++k) {
                const double xy = value(covariance_titles[3 * k + 1], row);
                covariances[k] << value(covariance_titles[3 * k], row), xy, xy,
                    value(covariance_titles[3 * k + 2], row);
            }
            tag.covariances_px2 = covariances;
        }
        made.recording.detections.push_back(tag);
    }
    made.notes.push_back(fmt::format("detections: {} of {}", ids.values.size(), ids.log->file.string()));
}

const LoggedCamera& find_camera(const std::vector<Log>& logs, const std::string& name,
                                const YamlValue& where) {
    std::string names;
    for (const Log& log : logs)
        for (const LoggedCamera& camera : log.cameras) {
            if (camera.name == name) return camera;
            names += (names.empty() ? "" : ", ") + camera.name;
        }
    where.fail(fmt::format("{}: there is no such camera; there {}", name,
                           names.empty() ? "is none" : "are " + names));
}

void add_camera(const std::vector<Log>& logs, SignalSource& source, const ImportMap& map, Assembled& made) {
    if (!map.camera) return;
    made.camera = &find_camera(logs, map.camera->images, *map.camera->where);
    made.frame_times_ns = source.on_recording_clock(made.camera->times_ns, map.camera->clock);
    for (TimeNs& time : made.frame_times_ns) time += nanoseconds(map.camera->offset_s);
    const auto before = std::ranges::adjacent_find(made.frame_times_ns, std::greater_equal<>());
    if (before != made.frame_times_ns.end())
        map.camera->where->fail(fmt::format("images: {}: times do not rise: {} ns, then {} ns",
                                            map.camera->images, *before, *(before + 1)));
    if (!map.camera->info.empty()) {
        for (const Log& log : logs)
            if (const auto text = log.texts.find(map.camera->info); text != log.texts.end())
                made.camera_info = text->second;
        if (made.camera_info.empty())
            map.camera->where->fail(fmt::format("info: {}: there is no such CameraInfo", map.camera->info));
    }
    made.notes.push_back(fmt::format("frames: {} of {}", made.frame_times_ns.size(), made.camera->name));
}

}  // namespace

Assembled assemble(const std::vector<Log>& logs, const ImportMap& map) {
    Assembled made;
    made.recording = map.stated;
    made.origin = map.origin;
    made.origin.program = this_program();
    made.decimals.fill(-1);
    SignalSource source(logs, map);
    made.notes = source.notes();
    add_stage(source, map, made);
    add_detections(source, map, made);
    add_camera(logs, source, map, made);
    if (made.recording.tick_s == 0.0)
        throw InputError(fmt::format("{}: recording.tick_s: missing: there are no columns that tell it",
                                     map.file.string()));
    if (!map.plate.empty()) made.recording.plate = load_plate(map.plate).tags;
    return made;
}

}  // namespace fidservo::imports
