// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/faults.h"

#include "core/input_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

constexpr double longest_s = 1e9;

[[noreturn]] void refuse_fault(const std::string& text, const std::string& why) {
    throw InputError(fmt::format("--fault {}: {}", text, why));
}

double seconds_of(const std::string& text, const std::string& value) {
    std::size_t used = 0;
    double number = NAN;
    try {
        number = std::stod(value, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != value.size() || !(number >= 0.0 && number <= longest_s))
        refuse_fault(text, fmt::format("'{}' is not a time; allowed: 0 to {:g} s", value, longest_s));
    return number;
}

}  // namespace

std::string_view name_of(FaultKind kind) {
    switch (kind) {
        case FaultKind::frames_dropped:
            return "frames_dropped";
        case FaultKind::frames_late:
            return "frames_late";
        case FaultKind::camera_silent:
            return "camera_silent";
        case FaultKind::image_frozen:
            return "image_frozen";
        case FaultKind::image_dark:
            return "image_dark";
        case FaultKind::image_bright:
            return "image_bright";
        case FaultKind::tag_hidden:
            return "tag_hidden";
        case FaultKind::camera_clock_step:
            return "camera_clock_step";
        case FaultKind::stage_clock_step:
            return "stage_clock_step";
        case FaultKind::encoder_jump:
            return "encoder_jump";
        case FaultKind::hall_stuck:
            return "hall_stuck";
        case FaultKind::heater_dead:
            return "heater_dead";
        case FaultKind::macro_jammed:
            return "macro_jammed";
    }
    return "";
}

Fault parse_fault(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const auto* kind = std::ranges::find(fault_kinds, name, [](FaultKind k) { return name_of(k); });
    if (kind == fault_kinds.end()) {
        std::vector<std::string_view> names;
        names.reserve(fault_kinds.size());
        for (const FaultKind one : fault_kinds) names.push_back(name_of(one));
        refuse_fault(text, fmt::format("no such fault; allowed: {}", fmt::join(names, ", ")));
    }
    Fault fault{*kind};
    for (std::size_t at = colon; at != std::string::npos;) {
        const std::size_t end = text.find(',', at + 1);
        const std::string setting = text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
        const std::size_t equals = setting.find('=');
        const std::string key = setting.substr(0, equals);
        if (equals == std::string::npos || (key != "from_s" && key != "for_s"))
            refuse_fault(text, fmt::format("'{}': allowed: from_s=SECONDS, for_s=SECONDS", setting));
        (key == "from_s" ? fault.from_s : fault.for_s) = seconds_of(text, setting.substr(equals + 1));
        at = end;
    }
    return fault;
}

}  // namespace fidservo
