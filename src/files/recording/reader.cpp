// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/reader.h"

#include "core/input_error.h"
#include "src/files/recording/csv_columns.h"
#include "src/files/recording/description.h"
#include "src/files/recording/frame_index.h"
#include "src/files/recording/last_digit.h"
#include "src/files/recording/layout.h"
#include "src/files/rig/plate_file.h"
#include "src/files/text/csv_text.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

constexpr ColumnTitle time_column{time_title, true};

void demand_header(CsvText& csv) {
    if (!csv.next()) csv.fail("there is no header");
}

/// Reads a time and demands that it does not run backwards.
TimeNs next_time(const CsvText& csv, std::size_t column, TimeNs last_ns, bool may_repeat) {
    const TimeNs time_ns = csv.integer(column);
    if (time_ns < last_ns || (time_ns == last_ns && !may_repeat))
        csv.fail(fmt::format("timestamp: {}: must be after the one before, {} ns", time_ns, last_ns));
    return time_ns;
}

constexpr TimeNs before_all_time = std::numeric_limits<TimeNs>::min();

/// A stage column of this file: where to read, where to put.
struct FieldTarget {
    std::size_t field;
    double StageRow::*value;
};

struct StageHeader {
    std::size_t fields;
    std::size_t time_field;
    std::vector<FieldTarget> targets;
};

StageHeader read_stage_header(const CsvText& csv, StageColumns& present) {
    std::vector<ColumnTitle> known{time_column};
    for (const StageColumn& column : stage_columns) known.push_back({column.title, false});
    const auto found = find_columns(csv, known);
    StageHeader header{csv.fields().size(), *found[0], {}};
    for (std::size_t i = 0; i < stage_columns.size(); ++i) {
        const auto& field = found[i + 1];
        present.*stage_columns[i].present = field.has_value();
        if (field) header.targets.push_back({*field, stage_columns[i].value});
    }
    if (present.encoder && present.position)
        csv.fail("has 'encoder [count]' and 'position [mm]'; one of them is allowed");
    if (!present.encoder && !present.position && !present.hall)
        csv.fail(
            "column 'encoder [count]', 'position [mm]' or 'hall [adc]' is missing: nothing was measured");
    return header;
}

void read_stage(CsvText csv, Recording& recording) {
    demand_header(csv);
    const StageHeader header = read_stage_header(csv, recording.columns);
    TimeNs last_ns = before_all_time;
    LastDigit setpoint;
    while (csv.next()) {
        csv.expect_fields(header.fields);
        StageRow row;
        row.time_ns = last_ns = next_time(csv, header.time_field, last_ns, false);
        for (const FieldTarget& target : header.targets) {
            const std::string_view text = csv.fields()[target.field];
            if (text.empty()) continue;
            row.*target.value = csv.number(target.field);
            if (target.value == &StageRow::macro_setpoint_mm) setpoint.saw(text);
        }
        recording.rows.push_back(row);
    }
    recording.macro_setpoint_step_mm = setpoint.step().value_or(recording.macro_setpoint_step_mm);
}

std::vector<FrameName> frame_names_in(CsvText csv) {
    demand_header(csv);
    constexpr std::array known{time_column, ColumnTitle{"filename", true}};
    const auto columns = find_columns(csv, known);
    std::vector<FrameName> frames;
    TimeNs last_ns = before_all_time;
    while (csv.next()) {
        csv.expect_fields(known.size());
        last_ns = next_time(csv, *columns[0], last_ns, false);
        frames.push_back({last_ns, std::string(csv.fields()[*columns[1]])});
        if (frames.back().filename.empty()) csv.fail("filename: is empty");
    }
    return frames;
}

/// Where the columns of a file of detections are.
struct DetectionHeader {
    std::size_t fields, time, id;
    std::array<std::size_t, corner_titles.size()> corners;
    std::optional<std::size_t> refined;
    std::optional<std::array<std::size_t, covariance_titles.size()>> covariances;
};

DetectionHeader read_detection_header(const CsvText& csv) {
    std::vector<ColumnTitle> known{time_column, {"tag_id", true}};
    for (const std::string_view title : corner_titles) known.push_back({title, true});
    known.push_back({refined_title, false});
    for (const std::string_view title : covariance_titles) known.push_back({title, false});
    const auto columns = find_columns(csv, known);
    DetectionHeader header{csv.fields().size(), *columns[0], *columns[1], {}, {}, {}};
    std::size_t next = 2;
    for (std::size_t& corner : header.corners) corner = *columns[next++];
    header.refined = columns[next++];
    const auto first = columns.begin() + static_cast<std::ptrdiff_t>(next);
    if (std::none_of(first, columns.end(), [](const auto& column) { return column.has_value(); }))
        return header;
    header.covariances.emplace();
    for (std::size_t k = 0; k < covariance_titles.size(); ++k) {
        if (!first[static_cast<std::ptrdiff_t>(k)])
            csv.fail(fmt::format("column '{}' is missing: give the covariances of all corners, or none",
                                 covariance_titles[k]));
        (*header.covariances)[k] = *first[static_cast<std::ptrdiff_t>(k)];
    }
    return header;
}

std::optional<bool> refined_in(const CsvText& csv, std::size_t column) {
    const std::string_view text = csv.fields()[column];
    if (text.empty()) return std::nullopt;
    if (text != "0" && text != "1") csv.fail(fmt::format("{}: {}: allowed: 0, 1", refined_title, text));
    return text == "1";
}

/// Empty where none of the fields says anything.
std::optional<CornerCovariances> covariances_in(
    const CsvText& csv, const std::array<std::size_t, covariance_titles.size()>& columns) {
    constexpr double rounded = 1e-3;  // more than what four digits leave of a correlation of 1
    if (std::ranges::all_of(columns, [&](std::size_t column) { return csv.fields()[column].empty(); }))
        return std::nullopt;
    CornerCovariances covariances;
    for (std::size_t corner = 0; corner < covariances.size(); ++corner) {
        const double xx = csv.number(columns[3 * corner]), xy = csv.number(columns[3 * corner + 1]),
                     yy = csv.number(columns[3 * corner + 2]);
        if (xx < 0.0 || yy < 0.0 || xy * xy > (1.0 + rounded) * xx * yy)
            csv.fail(
                fmt::format("covariance of corner {}: {}, {}, {}: is none; allowed: xx and yy not "
                            "negative, xy^2 at most xx yy",
                            corner, xx, xy, yy));
        covariances[corner] << xx, xy, xy, yy;
    }
    return covariances;
}

std::vector<TagDetection> detections_in(CsvText csv) {
    demand_header(csv);
    const DetectionHeader header = read_detection_header(csv);
    std::vector<TagDetection> detections;
    TimeNs last_ns = before_all_time;
    while (csv.next()) {
        csv.expect_fields(header.fields);
        TagDetection detection;
        detection.time_ns = last_ns = next_time(csv, header.time, last_ns, true);
        const std::int64_t id = csv.integer(header.id);
        if (id < 0 || id > std::numeric_limits<int>::max())
            csv.fail(fmt::format("tag_id: {}: must not be negative", id));
        detection.tag_id = static_cast<int>(id);
        for (std::size_t corner = 0; corner < 4; ++corner)
            detection.corners_px[corner] = {csv.number(header.corners[2 * corner]),
                                            csv.number(header.corners[2 * corner + 1])};
        if (header.refined) detection.is_refined = refined_in(csv, *header.refined);
        if (header.covariances) detection.covariances_px2 = covariances_in(csv, *header.covariances);
        detections.push_back(detection);
    }
    return detections;
}

}  // namespace

Recording read_recording(const fs::path& folder) {
    Recording recording;
    read_description(folder / "recording.yaml", recording);
    const auto table = [&](const fs::path& file) -> std::optional<CsvText> {
        if (!fs::exists(folder / file)) return std::nullopt;
        if (recording.is_unfinished) return CsvText::load_whole_lines(folder / file);
        return CsvText::load(folder / file);
    };
    if (const fs::path plate = folder / "plate.yaml"; fs::exists(plate))
        recording.plate = load_plate(plate).tags;
    if (auto csv = table("stage0/data.csv")) read_stage(*std::move(csv), recording);
    if (auto csv = table("cam0/data.csv")) recording.frames = frame_names_in(*std::move(csv));
    if (auto csv = table("cam0/detections.csv")) recording.detections = detections_in(*std::move(csv));
    give_print_of_plate(recording);
    return recording;
}

void give_print_of_plate(Recording& recording) {
    if (recording.plate.empty()) return;
    for (TagDetection& tag : recording.detections) tag.print = recording.plate.front().print;
}

std::vector<fs::path> find_recordings(const fs::path& path) {
    std::error_code error;
    if (fs::exists(path / "recording.yaml", error)) return {path};
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(path, error))
        if (fs::exists(entry.path() / "recording.yaml")) found.push_back(entry.path());
    const fs::path of_a_run = path / "recordings";
    if (found.empty() && !error && fs::is_directory(of_a_run)) return find_recordings(of_a_run);
    if (error) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), error.message()));
    if (found.empty())
        throw InputError(fmt::format(
            "{}: holds no recording: neither it nor a folder in it has a recording.yaml", path.string()));
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<FrameName> read_frame_names(const fs::path& file) {
    const fs::path recording = fs::absolute(file).parent_path().parent_path();
    if (fs::exists(recording / "recording.yaml")) return frame_names_in(CsvText::load(file));
    return read_frame_index(file);
}

std::vector<TagDetection> read_detections(const fs::path& file) {
    return detections_in(CsvText::load(file));
}

}  // namespace fidservo
