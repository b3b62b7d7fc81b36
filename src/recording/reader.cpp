#include "src/recording/reader.h"

#include "core/input_error.h"
#include "src/recording/csv_columns.h"
#include "src/recording/csv_text.h"
#include "src/recording/description.h"
#include "src/recording/layout.h"

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
    while (csv.next()) {
        csv.expect_fields(header.fields);
        StageRow row;
        row.time_ns = last_ns = next_time(csv, header.time_field, last_ns, false);
        for (const FieldTarget& target : header.targets)
            if (!csv.fields()[target.field].empty()) row.*target.value = csv.number(target.field);
        recording.rows.push_back(row);
    }
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

std::vector<TagDetection> detections_in(CsvText csv) {
    demand_header(csv);
    std::vector<ColumnTitle> known{time_column, {"tag_id", true}};
    for (const std::string_view title : corner_titles) known.push_back({title, true});
    const auto columns = find_columns(csv, known);
    std::vector<TagDetection> detections;
    TimeNs last_ns = before_all_time;
    while (csv.next()) {
        csv.expect_fields(known.size());
        TagDetection detection;
        detection.time_ns = last_ns = next_time(csv, *columns[0], last_ns, true);
        const std::int64_t id = csv.integer(*columns[1]);
        if (id < 0 || id > std::numeric_limits<int>::max())
            csv.fail(fmt::format("tag_id: {}: must not be negative", id));
        detection.tag_id = static_cast<int>(id);
        for (std::size_t corner = 0; corner < 4; ++corner)
            detection.corners_px[corner] = {csv.number(*columns[2 + 2 * corner]),
                                            csv.number(*columns[3 + 2 * corner])};
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
    if (auto csv = table("stage0/data.csv")) read_stage(*std::move(csv), recording);
    if (auto csv = table("cam0/data.csv")) recording.frames = frame_names_in(*std::move(csv));
    if (auto csv = table("cam0/detections.csv")) recording.detections = detections_in(*std::move(csv));
    return recording;
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
    return frame_names_in(CsvText::load(file));
}

std::vector<TagDetection> read_detections(const fs::path& file) {
    return detections_in(CsvText::load(file));
}

}  // namespace fidservo
