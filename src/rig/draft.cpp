// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/rig/draft.h"

#include "core/input_error.h"
#include "core/tag_families.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

const int family_size = usual_tag_family().size();

constexpr const char* head =
    R"(# A rig file to start from (docs/commissioning.md says how to go on, docs/formats.md what each key means).
# What is marked GUESS only your stage can tell: the command named there measures it, and with --write-rig puts it
# into a copy of this file. fidservo rig check FILE tells what can be done with it, and what looks wrong.
name: {name}
tick_s: {tick:g}                      # of the control loop
)";

constexpr const char* axis_part = R"(
macro:
  travel_mm: [{low:g}, {high:g}]
  command_limit_V: {limit:g}              # what the motor's amplifier takes, either sign
  encoder_resolution_mm: {resolution:g}      # a count
  velocity_gain_mm_per_s_per_V: {gain:.4g}  # GUESS: the travel in half a second at the full command. identify macro
  velocity_pole: {pole:.6g}             # GUESS: a time constant of 50 ms, exp(-tick / 0.05 s). identify macro
  dead_zone: {{ threshold_V: {threshold:.4g}, offset_V: 0, slope: 1 }}   # GUESS: below it friction holds the carriage; too little, and it sticks. identify macro
  # GUESS: follows setpoints of the axis above with a time constant of {loop_s:g} s; when that is measured, see whether rig check names others.
  pd: {{ e0_V_per_count: {e0:.4g}, e1_V_per_count: {e1:.4g}, friction_V: {threshold:.4g} }}
)";

constexpr const char* micro_part = R"(
micro:
  travel_mm: [{low:g}, {high:g}]
  heater:                            # the drive of the shape-memory wire
    onset_V: {onset:g}                     # below it the wire stays cold
    limit_V: {limit:g}                     # never more than this: the wire's current limit
    gain_degC_per_V: {gain:.4g}            # GUESS: {hot:g} degC above ambient at the limit. identify heater
    heating_tau_s: 0.5               # GUESS: a thin wire in air. identify heater
    cooling_tau_s: 1.0               # GUESS: likewise
    ambient_degC: 22                 # GUESS: read a thermometer
  preisach_fod: {fod}   # {fod_origin}. identify hysteresis
  hall:                              # GUESS: the sensor's range in the middle of the converter's. calibrate hall, calibrate stage
    {{ mid_V: {mid:g}, span_V: {span:g}, centre_mm: {centre:g}, half_range_mm: {half:g}, cubic: 0.1, adc_bits: {bits}, adc_range_V: {range:g}, noise_lsb: 0.5 }}
  pi: {{ kp_V_per_mm: {kp:.4g}, ki_V_per_mm_s: {ki:.4g}, kaw_per_s: {ki:.4g}, low_V: {onset:g}, high_V: {limit:g} }}   # GUESS: those of the published stage, scaled
)";

constexpr const char* camera_part = R"(
camera:                              # it looks straight down at the plate
  width_px: {width}
  height_px: {height}
  focal_px: {focal:g}                     # GUESS unless you know your lens: focal length / size of a pixel. calibrate camera
  principal_point_px: [{u0:g}, {v0:g}]   # GUESS: the middle of the image. calibrate camera
  distance_mm: {distance:g}                    # GUESS: from the lens to the plate. calibrate stage
  frame_rate_hz: {rate:g}
  exposure_s: {exposure:.3g}
  full_well_e: 10000                 # GUESS: of a small pixel. calibrate camera
  read_noise_e: 5                    # GUESS: likewise
  blur_px: 0.8                       # GUESS: a lens in focus
  latency_s: {latency:.3g}                   # GUESS: from the middle of the exposure to the frame's arrival; home measures it
  corner_noise_px: 0.02              # these two are the simulator's alone: detections that are not made from images
  max_speed_mm_per_s: 20
fiducials: {{ family: tag36h11, side_mm: {side:g}, pitch_mm: [{pitch:g}, {pitch_y:g}], count: [{columns}, {rows}], first_id: {first} }}   # side: of the black border
)";

constexpr const char* tail = R"(
# On a real board: which of its channels are the motor, the heater, the Hall sensor and the encoder (docs/devices.md)
# stage: {{ comedi: {{ macro: {{ subdevice: 1, channel: 0 }}, micro: {{ subdevice: 1, channel: 1 }}, hall: {{ subdevice: 0, channel: 0 }}, encoder: {{ subdevice: 4, channel: 0 }} }} }}
)";

/// The PD's zero stands on the axis' pole; what is left is a loop of one time constant. It is a few times the
/// axis' own, so that the guess may be wrong by as much.
constexpr double guessed_tau_s = 0.05, loop_tau_s = 0.2;

std::string axis_text(const RigDraft& draft) {
    constexpr double crossing_s = 0.5;
    const double threshold_V = friction_V_of(draft);
    const double gain =
        (draft.travel_mm[1] - draft.travel_mm[0]) / crossing_s / (draft.command_limit_V - threshold_V);
    const double pole = std::exp(-draft.tick_s / guessed_tau_s);
    const double e0 = draft.resolution_mm / (gain * loop_tau_s * (1.0 - pole));
    return fmt::format(axis_part, fmt::arg("low", draft.travel_mm[0]), fmt::arg("high", draft.travel_mm[1]),
                       fmt::arg("limit", draft.command_limit_V), fmt::arg("resolution", draft.resolution_mm),
                       fmt::arg("gain", gain), fmt::arg("pole", pole), fmt::arg("threshold", threshold_V),
                       fmt::arg("loop_s", loop_tau_s), fmt::arg("e0", e0), fmt::arg("e1", -pole * e0));
}

std::string micro_text(const RigDraft& draft, const std::string& fod) {
    constexpr double hot_degC = 160.0;
    constexpr double published_kp = 3.0, published_ki = 30.0, published_mm_per_V = 4.0 / 0.6;
    const double stroke_mm = draft.micro_travel_mm[1] - draft.micro_travel_mm[0];
    const double drive_V = draft.heater_limit_V - draft.heater_onset_V;
    const double scale = published_mm_per_V / (stroke_mm / drive_V);
    return fmt::format(micro_part, fmt::arg("low", draft.micro_travel_mm[0]),
                       fmt::arg("high", draft.micro_travel_mm[1]), fmt::arg("onset", draft.heater_onset_V),
                       fmt::arg("limit", draft.heater_limit_V), fmt::arg("gain", hot_degC / drive_V),
                       fmt::arg("hot", hot_degC), fmt::arg("fod", fod),
                       fmt::arg("fod_origin", "GUESS: wire temperature to contraction"),
                       fmt::arg("mid", 0.5 * draft.adc_range_V), fmt::arg("span", 0.25 * draft.adc_range_V),
                       fmt::arg("centre", 0.5 * (draft.micro_travel_mm[0] + draft.micro_travel_mm[1])),
                       fmt::arg("half", 0.5 * stroke_mm), fmt::arg("bits", draft.adc_bits),
                       fmt::arg("range", draft.adc_range_V), fmt::arg("kp", scale * published_kp),
                       fmt::arg("ki", scale * published_ki));
}

std::string camera_text(const RigDraft& draft) {
    constexpr double longest_exposure_s = 0.002, frames_late = 1.5;
    const double period_s = 1.0 / draft.frame_rate_hz;
    return fmt::format(
        camera_part, fmt::arg("width", draft.image_px[0]), fmt::arg("height", draft.image_px[1]),
        fmt::arg("focal", draft.focal_px), fmt::arg("u0", 0.5 * (draft.image_px[0] - 1)),
        fmt::arg("v0", 0.5 * (draft.image_px[1] - 1)), fmt::arg("distance", draft.distance_mm),
        fmt::arg("rate", draft.frame_rate_hz),
        fmt::arg("exposure", std::min(longest_exposure_s, 0.5 * period_s)),
        fmt::arg("latency", frames_late * period_s), fmt::arg("side", draft.tag_side_mm),
        fmt::arg("pitch", draft.pitch_mm), fmt::arg("pitch_y", draft.rows > 1 ? draft.pitch_mm : 0.0),
        fmt::arg("columns", columns_of(draft)), fmt::arg("rows", draft.rows),
        fmt::arg("first", draft.first_id));
}

}  // namespace

double friction_V_of(const RigDraft& draft) {
    constexpr double friction_share = 0.2;
    return draft.friction_V > 0.0 ? draft.friction_V : friction_share * draft.command_limit_V;
}

int columns_of(const RigDraft& draft) {
    if (draft.columns > 0) return draft.columns;
    const double needed = std::floor(std::max(0.0, draft.travel_mm[1]) / draft.pitch_mm) + 1.0;
    const int printed = (family_size - draft.first_id) / std::max(1, draft.rows);
    return std::max(1, static_cast<int>(std::min(needed, static_cast<double>(printed))));
}

void demand_sound(const RigDraft& draft) {
    const auto demand = [](bool sound, const std::string& complaint) {
        if (!sound) throw InputError(complaint);
    };
    const auto is_word = [](unsigned char letter) {
        return std::isalnum(letter) || letter == '-' || letter == '_';
    };
    demand(!draft.name.empty() && std::ranges::all_of(draft.name, is_word),
           fmt::format("--name: {}: must be a word of letters, digits, - and _", draft.name));
    const auto demand_rising = [&](const char* option, const std::array<double, 2>& ends) {
        demand(ends[0] < ends[1], fmt::format("{}: {:g},{:g}: must be LOW,HIGH with low below high, in mm",
                                              option, ends[0], ends[1]));
    };
    demand_rising("--travel-mm", draft.travel_mm);
    demand(draft.friction_V < draft.command_limit_V,
           fmt::format("--friction-V: {:g}: must be below --command-limit-V, {:g} V", draft.friction_V,
                       draft.command_limit_V));
    if (draft.has_micro()) {
        demand_rising("--micro-travel-mm", draft.micro_travel_mm);
        demand(draft.heater_onset_V < draft.heater_limit_V,
               fmt::format("--heater-limit-V: {:g}: must be above --heater-onset-V, {:g} V",
                           draft.heater_limit_V, draft.heater_onset_V));
    }
    if (!draft.has_camera()) return;
    demand(draft.pitch_mm > draft.tag_side_mm,
           fmt::format("--pitch-mm: {:g}: must be above --tag-side-mm, {:g} mm", draft.pitch_mm,
                       draft.tag_side_mm));
    demand(draft.first_id + columns_of(draft) * draft.rows <= family_size,
           fmt::format("--columns, --rows: {} x {} tags from {} on: the family tag36h11 has {}",
                       columns_of(draft), draft.rows, draft.first_id, family_size));
}

std::string rig_text(const RigDraft& draft, const std::string& fod) {
    std::string text = fmt::format(head, fmt::arg("name", draft.name), fmt::arg("tick", draft.tick_s));
    text += axis_text(draft);
    if (draft.has_micro()) text += micro_text(draft, fod);
    if (draft.has_camera()) text += camera_text(draft);
    return text + fmt::format(tail);
}

}  // namespace fidservo
