// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/frames_draw.h"

#include "core/rig.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/rounds.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

using reference::Departures;

void defocus(Departures& rig, double size_px, NoiseStream& /*draw*/) {
    rig.image.defocus_px = size_px;
}
void defocus_disc(Departures& rig, double size_px, NoiseStream& /*draw*/) {
    rig.image.defocus_px = size_px;
    rig.image.defocus_is_disc = true;
}
void motion_blur(Departures& rig, double size_s, NoiseStream& /*draw*/) {
    rig.image.extra_exposure_s = size_s;
}
void slope_of_light(Departures& rig, double size, NoiseStream& draw) {
    const double direction_rad = std::numbers::pi * (2.0 * draw.uniform() - 1.0);
    rig.image.light_u = size * std::cos(direction_rad);
    rig.image.light_v = size * std::sin(direction_rad);
}
void falloff_of_light(Departures& rig, double size, NoiseStream& draw) {
    slope_of_light(rig, 0.5 * size, draw);
    rig.image.light_falloff = size;
}
void read_noise(Departures& rig, double size_e, NoiseStream& /*draw*/) {
    rig.image.read_noise_e = size_e;
}
void unequal_gains(Departures& rig, double size, NoiseStream& /*draw*/) {
    rig.image.gain_spread = size;
}
void rolling_shutter(Departures& rig, double size_s, NoiseStream& draw) {
    rig.image.readout_s = random_sign(draw) * size_s;
}

constexpr std::array frame_draws{
    EffectDraw{"defocus", "", 0.18, 3.0, defocus},
    EffectDraw{"defocus", "disc", 0.18, 3.0, defocus_disc},
    EffectDraw{"motion_blur", "", 2e-3, 0.012, motion_blur},
    EffectDraw{"uneven_light", "", 0.02, 0.4, slope_of_light},
    EffectDraw{"uneven_light", "falloff", 0.03, 0.4, falloff_of_light},
    EffectDraw{"sensor_noise", "", 8.0, 200.0, read_noise},
    EffectDraw{"sensor_noise", "gains", 4e-3, 0.04, unequal_gains},
    EffectDraw{"rolling_shutter", "", 3e-4, 0.018, rolling_shutter},
};
constexpr double smallest_frame_floors = 0.7;

using enum CaseKind;
constexpr std::array frame_kinds{frames, frames, frames_withheld, frames_none};
constexpr KindCycle frame_cycle(frame_kinds, "frames/row");

}  // namespace

bool has_frames(CaseKind kind) {
    return frame_cycle.has(kind);
}

CaseKind kind_of_frames_case(std::uint64_t seed, std::size_t number) {
    return frame_cycle.kind_of(seed, number);
}

std::vector<std::string_view> effects_in_frames() {
    std::vector<std::string_view> names;
    for (const EffectDraw& way : frame_draws)
        if (names.empty() || names.back() != way.effect) names.push_back(way.effect);
    return names;
}

Case draw_frames_case(const Rig& nominal, std::uint64_t seed, std::size_t number) {
    NoiseStream draw(seed, fmt::format("self-check/frames/case/{}", number));
    Case drawn{.number = number,
               .label = {kind_of_frames_case(seed, number), {}},
               .true_rig = {nominal, {}},
               .without = {},
               .campaign_seed = draw.bits()};
    const CaseKind kind = drawn.label.kind;
    if (kind == frames_none) return drawn;
    const std::size_t k = frame_cycle.ordinal_of(seed, number);
    const std::vector<std::string_view> names = effects_in_frames();
    const std::string_view effect = met(std::span(names), seed, kind, k);
    std::vector<const EffectDraw*> ways;
    for (const EffectDraw& way : frame_draws)
        if (way.effect == effect) ways.push_back(&way);
    const EffectDraw& way = *ways[index_below(draw, ways.size())];
    const double size = log_uniform(draw, smallest_frame_floors * way.floor_size, way.largest);
    way.put(drawn.true_rig.departures, size, draw);
    drawn.label.effects.push_back({.effect = std::string(effect),
                                   .class_name = std::string(effect),
                                   .block = "camera.image",
                                   .formula = std::string(way.formula),
                                   .size = size,
                                   .expected_floors = size / way.floor_size});
    if (kind == frames_withheld) drawn.without.emplace_back(effect);
    return drawn;
}

}  // namespace fidservo::selfcheck
