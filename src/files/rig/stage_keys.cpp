// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/stage_keys.h"

#include <fmt/format.h>

namespace fidservo {

namespace {

using namespace control::comedi;

constexpr int most_subdevices = 255, most_channels = 65535;  ///< of Comedi's instructions

ChannelChoice read_choice(const YamlValue& map) {
    ChannelChoice choice{.subdevice = map.at("subdevice").integer(0, most_subdevices),
                         .channel = map.at("channel").integer(0, most_channels),
                         .range = {}};
    if (const auto range = map.find("range_V")) {
        const std::vector<double> ends = range->numbers(2);
        if (ends[0] >= ends[1]) range->fail("must be [low, high] with low below high, in V");
        choice.range = VoltageRange{ends[0], ends[1]};
    }
    return choice;
}

bool read_reversed(const YamlValue& map) {
    const auto reversed = map.find("reversed");
    return reversed && reversed->boolean();
}

MacroChannel read_macro_channel(const YamlValue& map) {
    map.allow_only({"subdevice", "channel", "range_V", "reversed", "direction"});
    MacroChannel macro{.output = read_choice(map), .reversed = read_reversed(map), .direction = {}};
    if (const auto line = map.find("direction")) {
        line->allow_only({"subdevice", "channel"});
        macro.direction = read_choice(*line);
    }
    return macro;
}

ChannelChoice read_plain(const YamlValue& map) {
    map.allow_only({"subdevice", "channel", "range_V"});
    return read_choice(map);
}

EncoderChannel read_encoder(const YamlValue& map) {
    map.allow_only({"subdevice", "channel", "range_V", "reversed", "mm_per_V"});
    EncoderChannel encoder{.input = read_choice(map), .reversed = read_reversed(map), .mm_per_V = {}};
    if (const auto scale = map.find("mm_per_V")) encoder.mm_per_V = scale->number(positive);
    if (encoder.input.range && !encoder.mm_per_V)
        map.at("range_V").fail("belongs to a position on an analogue input; mm_per_V is missing");
    return encoder;
}

ChannelMap read_comedi(const YamlValue& map) {
    map.allow_only({"macro", "micro", "hall", "encoder"});
    return {.macro = read_macro_channel(map.at("macro")),
            .micro = read_plain(map.at("micro")),
            .hall = read_plain(map.at("hall")),
            .encoder = read_encoder(map.at("encoder"))};
}

WatchdogKeys read_watchdog(const YamlValue& map) {
    map.allow_only({"late_ticks", "wire_limit_degC", "following_limit_mm"});
    WatchdogKeys keys;
    if (const auto late = map.find("late_ticks")) keys.late_ticks = late->integer(5, 1000);
    if (const auto limit = map.find("wire_limit_degC")) keys.wire_limit_degC = limit->number({30.0, 500.0});
    if (const auto limit = map.find("following_limit_mm")) keys.following_limit_mm = limit->number(positive);
    return keys;
}

}  // namespace

StageKeys read_stage_keys(const YamlValue& map) {
    map.allow_only({"comedi", "watchdog"});
    StageKeys keys;
    if (const auto comedi = map.find("comedi")) keys.comedi = read_comedi(*comedi);
    if (const auto watchdog = map.find("watchdog")) keys.watchdog = read_watchdog(*watchdog);
    return keys;
}

StageKeys load_stage_keys(const std::filesystem::path& rig_file) {
    const auto stage = YamlValue::load(rig_file).find("stage");
    return stage ? read_stage_keys(*stage) : StageKeys{};
}

control::WatchdogParams watchdog_params(const Rig& rig, const WatchdogKeys& keys) {
    control::WatchdogParams params = control::watchdog_params(rig);
    params.late_ticks = keys.late_ticks.value_or(params.late_ticks);
    params.wire_limit_degC = keys.wire_limit_degC.value_or(params.wire_limit_degC);
    params.following_limit_mm = keys.following_limit_mm.value_or(params.following_limit_mm);
    return params;
}

}  // namespace fidservo
