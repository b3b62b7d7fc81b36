// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/export_log.h"

#include "core/input_error.h"
#include "src/files/disk/durable_file.h"
#include "src/files/recording/layout.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/plate_file.h"
#include "src/import/import_map.h"
#include "src/import/import_module.h"
#include "src/import/recording_folder.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace fidservo::imports {
namespace {

namespace fs = std::filesystem;

/// How a format joins a group's name and a signal's.
std::string joined(ExportFormat format, std::string_view group, const std::string& name) {
    return format == ExportFormat::hdf5 ? fmt::format("/{}/{}", group, name)
                                        : fmt::format("{}.{}", group, name);
}

void add_times(const auto& rows, const std::string& name, Log& log) {
    LoggedSignal times{.name = name, .unit = "ns"};
    for (const auto& row : rows) {
        times.whole.push_back(row.time_ns);
        times.values.push_back(static_cast<double>(row.time_ns));
    }
    log.signals.push_back(std::move(times));
}

void add_exported_stage(const Recording& recording, ExportFormat format, Log& log, std::string& columns) {
    add_times(recording.rows, joined(format, "stage", "time_ns"), log);
    for (const StageColumn& column : stage_columns) {
        if (!(recording.columns.*column.present)) continue;
        LoggedSignal signal{.name = joined(format, "stage", exported_name(column.title)),
                            .unit = std::string(unit_of_title(column.title))};
        for (const StageRow& row : recording.rows) signal.values.push_back(row.*column.value);
        columns += fmt::format("  {}: {{ signal: {}, unit: {}, clock: stage{} }}\n",
                               name_of_title(column.title), signal.name, signal.unit,
                               column.value == &StageRow::macro_setpoint_mm
                                   ? fmt::format(", decimals: {}", setpoint_decimals(recording))
                                   : "");
        log.signals.push_back(std::move(signal));
    }
}

void add_exported_detections(const Recording& recording, ExportFormat format, Log& log, std::string& map) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const std::vector<TagDetection>& tags = recording.detections;
    const auto add = [&](std::string_view title, const auto& value) {
        LoggedSignal signal{.name = joined(format, "detections", exported_name(title)),
                            .unit = std::string(unit_of_title(title))};
        for (const TagDetection& tag : tags) signal.values.push_back(value(tag));
        map += fmt::format("  {}: {{ signal: {}{}, clock: camera }}\n", name_of_title(title), signal.name,
                           signal.unit.empty() ? "" : fmt::format(", unit: {}", signal.unit));
        log.signals.push_back(std::move(signal));
    };
    add_times(tags, joined(format, "detections", "time_ns"), log);
    map += "detections:\n";
    add("tag_id", [](const TagDetection& tag) { return static_cast<double>(tag.tag_id); });
    for (std::size_t k = 0; k < corner_titles.size(); ++k)
        add(corner_titles[k],
            [k](const TagDetection& tag) { return tag.corners_px[k / 2][static_cast<Eigen::Index>(k % 2)]; });
    const bool has_more = std::ranges::any_of(
        tags, [](const TagDetection& tag) { return tag.is_refined || tag.covariances_px2; });
    if (!has_more) return;
    add(refined_title, [&](const TagDetection& tag) {
        return tag.is_refined ? static_cast<double>(*tag.is_refined) : nothing;
    });
    constexpr std::array<std::pair<int, int>, 3> terms{{{0, 0}, {0, 1}, {1, 1}}};
    for (std::size_t k = 0; k < covariance_titles.size(); ++k)
        add(covariance_titles[k], [&, k](const TagDetection& tag) {
            return tag.covariances_px2
                       ? (*tag.covariances_px2)[k / 3](terms[k % 3].first, terms[k % 3].second)
                       : nothing;
        });
}

/// `recording:` of the map: recording.yaml, indented, without what a map does not have.
std::string recording_part(const fs::path& folder, const Recording& recording) {
    RecordingOrigin origin = read_origin(folder / "recording.yaml");
    origin.program.clear();
    std::string part = "recording:\n", description = description_yaml(recording, origin);
    for (std::string_view rest = description; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        if (!line.starts_with("format:") && !line.starts_with("finished:"))
            part += fmt::format("  {}\n", line);
    }
    return part;
}

/// The log, with its map among the texts.
Log exported(const fs::path& folder, const Recording& recording, ExportFormat format) {
    Log log{.file = folder};
    std::string columns, detections, clocks = "clocks:\n";
    const auto name_clock = [&](std::string_view clock, std::string_view group) {
        clocks += fmt::format("  {}: {{ signal: {}, unit: ns }}\n", clock, joined(format, group, "time_ns"));
    };
    if (!recording.rows.empty()) {
        add_exported_stage(recording, format, log, columns);
        name_clock("stage", "stage");
        columns = "columns:\n" + columns;
    }
    if (!recording.detections.empty()) {
        add_exported_detections(recording, format, log, detections);
        name_clock("camera", "detections");
    }
    if (log.signals.empty())
        throw InputError(fmt::format("{}: holds no rows of the stage and no detections", folder.string()));
    log.texts[map_text] = fmt::format("format: {}\n{}{}{}{}", map_format, recording_part(folder, recording),
                                      clocks, columns, detections);
    if (!recording.plate.empty()) log.texts[plate_text] = plate_yaml(recording.plate);
    return log;
}

void demand_absent(const fs::path& file) {
    if (fs::exists(file))
        throw InputError(fmt::format("--out: {}: exists already; nothing is overwritten", file.string()));
    if (const fs::path folder = fs::absolute(file).parent_path(); !fs::is_directory(folder))
        throw InputError(fmt::format("--out: {}: there is no folder {}", file.string(), folder.string()));
}

fs::path beside(const fs::path& file, std::string_view ending) {
    return file.parent_path() / (file.stem().string() + std::string(ending));
}

/// A file's name as text of YAML, whatever is in it.
std::string in_quotes(const std::string& name) {
    YAML::Emitter yaml;
    yaml << YAML::DoubleQuoted << name;
    return yaml.c_str();
}

std::vector<std::string> write_csv(const fs::path& file, const Recording& recording, const Log& log) {
    const fs::path detections = beside(file, "-detections.csv"), map = beside(file, ".map.yaml"),
                   plate = beside(file, ".plate.yaml");
    for (const fs::path& path : {file, detections, map, plate}) demand_absent(path);
    std::vector<std::string> written;
    const auto write = [&](const fs::path& path, const std::string& text) {
        write_or_throw(path, text);
        written.push_back(path.string());
    };
    if (!recording.rows.empty()) write(file, stage_text(recording, decimals_without_log(recording)));
    if (!recording.detections.empty()) write(detections, detections_text(recording.detections));
    std::string text = log.texts.at(map_text);
    if (!recording.plate.empty()) {
        write(plate, log.texts.at(plate_text));
        text += fmt::format("plate: {}\n", in_quotes(plate.filename().string()));
    }
    write(map, text);
    return written;
}

/// In a CSV file signals have the titles of a recording's own files.
std::string csv_map(std::string map, const fs::path& file) {
    const auto replace_all = [&](std::string_view from, const std::string& to) {
        for (auto at = map.find(from); at != std::string::npos; at = map.find(from, at + to.size()))
            map.replace(at, from.size(), to);
    };
    for (const StageColumn& column : stage_columns)
        replace_all("signal: stage." + exported_name(column.title) + ",",
                    fmt::format("signal: {},", name_of_title(column.title)));
    const auto replace_detection = [&](std::string_view title) {
        replace_all("signal: detections." + exported_name(title) + ",",
                    fmt::format("signal: {},", name_of_title(title)));
    };
    for (const std::string_view title : corner_titles) replace_detection(title);
    for (const std::string_view title : covariance_titles) replace_detection(title);
    replace_detection("tag_id");
    replace_detection(refined_title);
    const auto times_of = [](const fs::path& table) {
        return fmt::format("signal: {},", in_quotes(table.stem().string() + ":timestamp"));
    };
    replace_all("signal: stage.time_ns,", times_of(file));
    replace_all("signal: detections.time_ns,", times_of(beside(file, "-detections.csv")));
    return map;
}

}  // namespace

std::string exported_name(std::string_view title) {
    std::string name(name_of_title(title));
    std::string unit(unit_of_title(title));
    std::erase(unit, '^');
    return unit.empty() ? name : name + "_" + unit;
}

std::vector<std::string> export_recording(const fs::path& folder, ExportFormat format, const fs::path& file) {
    const Recording recording = read_recording(folder);
    Log log = exported(folder, recording, format);
    std::vector<std::string> written{file.string()};
    if (format == ExportFormat::csv) {
        log.texts[map_text] = csv_map(log.texts[map_text], file);
        written = write_csv(file, recording, log);
    } else {
        demand_absent(file);
        const ImportModule& module = import_module(file);
        const std::string fault =
            (format == ExportFormat::mat ? module.write_mat : module.write_hdf5)(file.c_str(), log);
        if (!fault.empty()) {
            std::error_code ignored;
            fs::remove(file, ignored);
            throw RunFault(fmt::format("{}: {}", file.string(), fault));
        }
    }
    if (!recording.frames.empty())
        written.push_back(fmt::format("{} frames stay in {}: images are not exported",
                                      recording.frames.size(), (folder / "cam0/data").string()));
    if (!recording.is_unfinished) return written;
    written.emplace_back("the recording is unfinished, which the file does not say");
    return written;
}

}  // namespace fidservo::imports
