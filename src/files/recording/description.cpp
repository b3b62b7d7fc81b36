// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/description.h"

#include "src/files/recording/layout.h"
#include "src/files/recording/utc_time.h"
#include "src/files/text/yaml_reader.h"
#include "src/process/commit.h"

#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {

namespace {

/// The shortest text that reads back as the same number.
std::string number_text(double value) {
    return fmt::format("{}", value);
}

void emit_if_stated(YAML::Emitter& yaml, const char* key, const std::string& text) {
    if (!text.empty()) yaml << YAML::Key << key << YAML::Value << text;
}

void emit(YAML::Emitter& yaml, const EncoderZero& zero) {
    yaml << YAML::Key << "encoder_zero" << YAML::Value << YAML::Flow << YAML::BeginMap;
    yaml << YAML::Key << "count" << YAML::Value << number_text(zero.count);
    yaml << YAML::Key << "std_count" << YAML::Value << number_text(zero.std_count);
    if (!zero.how.empty()) yaml << YAML::Key << "how" << YAML::Value << YAML::DoubleQuoted << zero.how;
    yaml << YAML::EndMap;
}

void emit(YAML::Emitter& yaml, const ControllerNames& controllers) {
    yaml << YAML::Key << "controllers" << YAML::Value << YAML::Flow << YAML::BeginMap;
    emit_if_stated(yaml, "macro", controllers.macro);
    emit_if_stated(yaml, "micro", controllers.micro);
    yaml << YAML::EndMap;
}

void emit(YAML::Emitter& yaml, const std::vector<RecordingEvent>& events) {
    yaml << YAML::Key << "events" << YAML::Value << YAML::BeginSeq;
    for (const RecordingEvent& event : events) {
        yaml << YAML::Flow << YAML::BeginMap;
        yaml << YAML::Key << "time_ns" << YAML::Value << event.time_ns;
        yaml << YAML::Key << "what" << YAML::Value << event.what;
        if (!event.text.empty())
            yaml << YAML::Key << "text" << YAML::Value << YAML::DoubleQuoted << event.text;
        yaml << YAML::EndMap;
    }
    yaml << YAML::EndSeq;
}

/// Text in quotes: a reader of YAML is not to take a unit "7" for a number.
void emit_subject(YAML::Emitter& yaml, const RecordingOrigin& subject) {
    if (!subject.unit.empty())
        yaml << YAML::Key << "unit" << YAML::Value << YAML::DoubleQuoted << subject.unit;
    emit_if_stated(yaml, "recorded_at", subject.recorded_at);
    if (subject.labels.empty()) return;
    yaml << YAML::Key << "labels" << YAML::Value << YAML::Flow << YAML::BeginMap;
    for (const auto& [key, value] : subject.labels)
        yaml << YAML::Key << YAML::DoubleQuoted << key << YAML::Value << YAML::DoubleQuoted << value;
    yaml << YAML::EndMap;
}

EncoderZero encoder_zero_of(const YamlValue& yaml) {
    yaml.allow_only({"count", "std_count", "how"});
    EncoderZero zero{yaml.at("count").number(), yaml.at("std_count").number(not_negative), {}};
    if (const auto how = yaml.find("how")) zero.how = how->text();
    return zero;
}

/// A name, or a map of the name and the numbers that the controller was given.
std::string name_of_controller(const YamlValue& yaml) {
    if (!yaml.is_map()) return yaml.text();
    for (const std::string& key : yaml.keys())
        if (key != "name") (void)yaml.at(key).number();
    return yaml.at("name").text();
}

ControllerNames controllers_of(const YamlValue& yaml) {
    yaml.allow_only({"macro", "micro"});
    ControllerNames names;
    if (const auto macro = yaml.find("macro")) {
        names.macro = name_of_controller(*macro);
        if (names.macro == controller_name::pi_antiwindup) macro->fail("is a controller of the micro stage");
    }
    if (const auto micro = yaml.find("micro")) {
        names.micro = name_of_controller(*micro);
        if (names.micro == controller_name::nonlinear_pd || names.micro == controller_name::benchmark_pid)
            micro->fail("is a controller of the macro stage");
    }
    if (names.macro.empty() && names.micro.empty()) yaml.fail("names no controller; allowed: macro, micro");
    return names;
}

std::vector<RecordingEvent> events_of(const YamlValue& yaml) {
    std::vector<RecordingEvent> events;
    for (const YamlValue& item : yaml.items()) {
        item.allow_only({"time_ns", "what", "text"});
        RecordingEvent event{item.at("time_ns").whole_number(), item.at("what").text(), {}};
        if (const auto text = item.find("text")) event.text = text->text();
        if (!events.empty() && event.time_ns < events.back().time_ns)
            item.at("time_ns").fail(
                fmt::format("must not be before the event before it, {} ns", events.back().time_ns));
        events.push_back(std::move(event));
    }
    return events;
}

}  // namespace

std::string this_program() {
    return fmt::format("fidservo {} ({})", program_version(), built_from_commit());
}

std::string description_yaml(const Recording& recording, const RecordingOrigin& origin) {
    YAML::Emitter yaml;
    yaml << YAML::BeginMap;
    yaml << YAML::Key << "format" << YAML::Value << std::string(recording_format);
    yaml << YAML::Key << "name" << YAML::Value << recording.name;
    yaml << YAML::Key << "rig" << YAML::Value << recording.rig;
    yaml << YAML::Key << "tick_s" << YAML::Value << number_text(recording.tick_s);
    yaml << YAML::Key << "experiment" << YAML::Value << recording.experiment;
    emit_subject(yaml, origin);
    emit_if_stated(yaml, "stage", origin.stage);
    emit_if_stated(yaml, "camera", origin.camera);
    emit_if_stated(yaml, "program", origin.program);
    emit_if_stated(yaml, "request_sha256", origin.request_sha256);
    if (recording.encoder_zero) emit(yaml, *recording.encoder_zero);
    if (recording.controllers) emit(yaml, *recording.controllers);
    yaml << YAML::Key << "finished" << YAML::Value << !recording.is_unfinished;
    if (!recording.events.empty()) emit(yaml, recording.events);
    yaml << YAML::EndMap;
    return std::string(yaml.c_str()) + '\n';
}

RecordingOrigin read_origin(const YamlValue& map) {
    RecordingOrigin origin;
    for (const auto& [key, text] : {std::pair{"stage", &origin.stage}, std::pair{"camera", &origin.camera},
                                    std::pair{"program", &origin.program}, std::pair{"unit", &origin.unit},
                                    std::pair{"request_sha256", &origin.request_sha256}})
        if (const auto value = map.find(key)) *text = value->text();
    if (const auto time = map.find("recorded_at")) {
        origin.recorded_at = time->text();
        if (!is_utc_time(origin.recorded_at)) time->fail("must be a time in UTC like 2026-11-02T08:15:00Z");
    }
    if (const auto labels = map.find("labels"))
        for (const std::string& key : labels->keys()) origin.labels[key] = labels->at(key).text();
    return origin;
}

RecordingOrigin read_origin(const std::filesystem::path& file) {
    return read_origin(YamlValue::load(file));
}

void read_statements(const YamlValue& map, Recording& recording) {
    recording.name = map.at("name").text();
    recording.rig = map.at("rig").text();
    recording.experiment = map.at("experiment").text();
    recording.is_seen = map.find("camera").has_value();
    (void)read_origin(map);
    if (const auto zero = map.find("encoder_zero")) recording.encoder_zero = encoder_zero_of(*zero);
    if (const auto names = map.find("controllers")) recording.controllers = controllers_of(*names);
    if (const auto events = map.find("events")) recording.events = events_of(*events);
}

void read_description(const std::filesystem::path& file, Recording& recording) {
    const YamlValue root = YamlValue::load(file);
    root.allow_only({"format", "name", "rig", "tick_s", "experiment", "stage", "camera", "program",
                     "encoder_zero", "controllers", "finished", "events", "unit", "recorded_at",
                     "request_sha256", "labels"});
    root.at("format").one_of({recording_format});
    read_statements(root, recording);
    recording.tick_s = root.at("tick_s").number({0.0, 1.0, true});
    if (const auto finished = root.find("finished")) recording.is_unfinished = !finished->boolean();
}

}  // namespace fidservo
