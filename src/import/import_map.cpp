// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/import_map.h"

#include "src/files/recording/description.h"
#include "src/files/recording/layout.h"
#include "src/identify/column_units.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

constexpr int most_decimals = 12;
constexpr NumberRange any_offset_s{-4e9, 4e9}, any_exposure_s{-1e3, 1e3};

/// "NAME [UNIT]" or "NAME".
SignalChoice choice_of_text(const YamlValue& yaml) {
    SignalChoice choice;
    choice.where = yaml;
    const std::string text = yaml.text();
    const auto open = text.rfind(" [");
    if (open == std::string::npos || !text.ends_with(']')) {
        choice.signal = text;
    } else {
        choice.signal = text.substr(0, open);
        choice.unit = text.substr(open + 2, text.size() - open - 3);
    }
    if (choice.signal.empty()) yaml.fail("must be the name of a signal, or a map with the key signal");
    return choice;
}

SignalChoice read_choice(const YamlValue& yaml) {
    if (!yaml.is_map()) return choice_of_text(yaml);
    yaml.allow_only({"signal", "unit", "factor", "offset", "clock", "between", "decimals"});
    SignalChoice choice;
    choice.where = yaml;
    choice.signal = yaml.at("signal").text();
    if (const auto unit = yaml.find("unit")) choice.unit = unit->text();
    if (const auto factor = yaml.find("factor")) {
        choice.factor = factor->number();
        choice.has_factor = true;
        if (choice.factor == 0.0) factor->fail("must not be 0");
    }
    if (const auto offset = yaml.find("offset")) choice.offset = offset->number();
    if (const auto clock = yaml.find("clock")) choice.clock = clock->text();
    if (const auto between = yaml.find("between")) choice.is_held = between->one_of({"line", "hold"}) == 1;
    if (const auto decimals = yaml.find("decimals")) choice.decimals = decimals->integer(0, most_decimals);
    return choice;
}

ClockChoice read_clock(const YamlValue& yaml, const std::string& name) {
    ClockChoice clock;
    clock.name = name;
    clock.where = yaml;
    if (!yaml.is_map()) {
        clock.times = choice_of_text(yaml);
        return clock;
    }
    yaml.allow_only({"signal", "unit", "rate_hz", "offset_s", "rate_ppm", "fit"});
    clock.times.where = yaml;
    if (const auto signal = yaml.find("signal")) clock.times.signal = signal->text();
    if (const auto unit = yaml.find("unit")) clock.times.unit = unit->text();
    if (const auto rate = yaml.find("rate_hz")) clock.rate_hz = rate->number(positive);
    if (clock.rate_hz && !clock.times.signal.empty())
        yaml.fail("has both signal and rate_hz; one of them is allowed");
    if (const auto offset = yaml.find("offset_s")) clock.offset_s = offset->number(any_offset_s);
    constexpr double most_ppm = 1e5;
    if (const auto rate = yaml.find("rate_ppm")) clock.rate_ppm = rate->number({-most_ppm, most_ppm});
    if (const auto fit = yaml.find("fit")) {
        fit->allow_only({"signal", "to"});
        clock.fit = ClockFitChoice{fit->at("signal").text(), fit->at("to").text()};
        if (yaml.find("offset_s") || yaml.find("rate_ppm"))
            fit->fail("finds offset_s and rate_ppm; they must not be given beside it");
    }
    return clock;
}

std::vector<ClockChoice> read_clocks(const YamlValue& root) {
    const auto time = root.find("time");
    const auto clocks = root.find("clocks");
    if (time && clocks) time->fail("is the one clock; give either this or clocks");
    if (time) {
        ClockChoice clock = read_clock(*time, "time");
        if (clock.fit) time->fail("has fit, which needs another clock to be fitted to; give clocks");
        return {std::move(clock)};
    }
    std::vector<ClockChoice> all;
    if (!clocks) return all;
    for (const std::string& name : clocks->keys()) all.push_back(read_clock(clocks->at(name), name));
    if (all.empty()) clocks->fail("names no clock");
    if (all.front().fit)
        all.front().where->fail("is the recording's own clock; the others may be fitted to it");
    return all;
}

std::map<std::string, SignalChoice> read_choices(const YamlValue& yaml,
                                                 const std::vector<std::string>& allowed) {
    std::map<std::string, SignalChoice> choices;
    for (const std::string& key : yaml.keys()) {
        if (std::ranges::find(allowed, key) == allowed.end())
            yaml.at(key).fail(fmt::format("is no column; allowed: {}", fmt::join(allowed, ", ")));
        choices[key] = read_choice(yaml.at(key));
    }
    return choices;
}

std::vector<std::string> stage_names() {
    std::vector<std::string> names;
    names.reserve(stage_columns.size());
    for (const StageColumn& column : stage_columns) names.emplace_back(name_of_title(column.title));
    return names;
}

void read_detections_part(const YamlValue& yaml, ImportMap& map) {
    std::vector<std::string> required{"tag_id"}, allowed;
    for (const std::string_view title : corner_titles) required.emplace_back(name_of_title(title));
    allowed = required;
    allowed.emplace_back(refined_title);
    for (const std::string_view title : covariance_titles) allowed.emplace_back(name_of_title(title));
    map.detections = read_choices(yaml, allowed);
    for (const std::string& name : required)
        if (!map.detections.contains(name)) yaml.fail(fmt::format("{} is missing", name));
    std::size_t covariances = 0;
    for (const std::string_view title : covariance_titles)
        covariances += map.detections.count(std::string(name_of_title(title)));
    if (covariances != 0 && covariances != covariance_titles.size())
        yaml.fail("has some of p0_xx .. p3_yy; all twelve or none are allowed");
}

TableOptions read_table_options(const YamlValue& yaml) {
    yaml.allow_only({"header_lines", "decimal", "separator"});
    constexpr int most_lines = 1'000'000;
    constexpr std::string_view signs = "\t;,| ";
    TableOptions options{.are_offered = false};
    if (const auto lines = yaml.find("header_lines")) options.header_lines = lines->integer(0, most_lines);
    if (const auto decimal = yaml.find("decimal"))
        options.decimal = decimal->one_of({"point", "comma"}) == 0 ? DecimalSign::point : DecimalSign::comma;
    if (const auto separator = yaml.find("separator"))
        options.separator = signs[separator->one_of({"tab", "semicolon", "comma", "bar", "blank"})];
    return options;
}

CameraChoice read_camera(const YamlValue& yaml) {
    yaml.allow_only({"images", "info", "clock", "offset_s"});
    CameraChoice camera;
    camera.where = yaml;
    camera.images = yaml.at("images").text();
    if (const auto info = yaml.find("info")) camera.info = info->text();
    if (const auto clock = yaml.find("clock")) camera.clock = clock->text();
    if (const auto offset = yaml.find("offset_s")) camera.offset_s = offset->number(any_exposure_s);
    return camera;
}

void demand_clock(const ImportMap& map, const SignalChoice& choice) {
    if (!choice.clock.empty() && map.clock(choice.clock) == nullptr)
        choice.where->fail(fmt::format("clock: {}: is not one of clocks", choice.clock));
}

ImportMap read_import_map(const YamlValue& root) {
    root.allow_only(
        {"format", "recording", "table", "time", "clocks", "columns", "detections", "camera", "plate"});
    root.at("format").one_of({map_format});
    ImportMap map;
    map.file = root.source();
    map.table.are_offered = false;
    const YamlValue recording = root.at("recording");
    recording.allow_only({"name", "rig", "tick_s", "experiment", "stage", "camera", "encoder_zero",
                          "controllers", "events", "unit", "recorded_at", "labels"});
    read_statements(recording, map.stated);
    map.origin = read_origin(recording);
    if (const auto tick = recording.find("tick_s")) map.stated.tick_s = tick->number({0.0, 1.0, true});
    if (const auto table = root.find("table")) map.table = read_table_options(*table);
    map.clocks = read_clocks(root);
    if (const auto columns = root.find("columns")) map.columns = read_choices(*columns, stage_names());
    if (const auto detections = root.find("detections")) read_detections_part(*detections, map);
    if (const auto camera = root.find("camera")) map.camera = read_camera(*camera);
    if (const auto plate = root.find("plate")) map.plate = plate->file();
    if (map.columns.empty() && map.detections.empty() && !map.camera)
        root.fail("asks for nothing: columns, detections or camera is missing");
    if (map.columns.contains("encoder") && map.columns.contains("position"))
        map.columns.at("position").where->fail("stands beside encoder; one of them is allowed");
    for (const auto* choices : {&map.columns, &map.detections})
        for (const auto& [name, choice] : *choices) demand_clock(map, choice);
    if (map.camera && !map.camera->clock.empty() && map.clock(map.camera->clock) == nullptr)
        map.camera->where->fail(fmt::format("clock: {}: is not one of clocks", map.camera->clock));
    return map;
}

}  // namespace

const ClockChoice* ImportMap::clock(std::string_view name) const {
    const auto found = std::ranges::find(clocks, name, &ClockChoice::name);
    return found == clocks.end() ? nullptr : &*found;
}

ImportMap load_import_map(const std::filesystem::path& file) {
    return read_import_map(YamlValue::load(file));
}

ImportMap parse_import_map(const std::string& text, const std::filesystem::path& file) {
    return read_import_map(YamlValue::parse(text, file));
}

std::string_view name_of_title(std::string_view title) {
    return title.substr(0, title.find(" ["));
}

std::string_view unit_of_title(std::string_view title) {
    const auto open = title.find(" [");
    return open == std::string_view::npos ? std::string_view()
                                          : title.substr(open + 2, title.size() - open - 3);
}

}  // namespace fidservo::imports
