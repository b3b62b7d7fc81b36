// SPDX-License-Identifier: GPL-3.0-or-later
// Fiducial-relative positioning end to end, through rendered images, tested against the simulated plant's
// true state: on the nominal rig, and on rigs that differ from their file without the session's knowing it.
#include "core/failure.h"
#include "core/random.h"
#include "core/rig.h"
#include "core/units.h"
#include "tests/effort.h"
#include "tests/session/watched_rig.h"

#include <cmath>
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr double tolerance_mm = 0.005;
constexpr double frame_period_s = 0.02;

struct RigCase {
    const char* name;
    std::function<void(plant::PlantParameters&)> change;
    int targets = fidservo::testing::draws(60, 20);
};

std::ostream& operator<<(std::ostream& out, const RigCase& rig_case) {
    return out << rig_case.name;
}

/// Time in s that full power (or none) takes from a state until the camera crosses the target.
double bang_bang_s(const plant::StagePlant& plant, plant::StageState state, double target_mm) {
    const bool up = target_mm > plant::camera_position_mm(state);
    double before_mm = plant::camera_position_mm(state);
    for (int tick = 0; tick < 10'000; ++tick) {
        plant::advance(plant, state, 0.0, up ? 5.0 : 0.0);
        const double s_mm = plant::camera_position_mm(state);
        if (up ? s_mm >= target_mm : s_mm <= target_mm)
            return plant.tick_s * (tick + (target_mm - before_mm) / (s_mm - before_mm));
        before_mm = s_mm;
    }
    return std::numeric_limits<double>::infinity();
}

class Positioning : public ::testing::TestWithParam<RigCase> {};

TEST_P(Positioning, RandomTargets_WithinFiveMicrometresInBangBangTime) {
    const int targets = GetParam().targets;
    constexpr std::uint64_t seed = 2026;
    plant::PlantParameters physics = reference_physics();
    physics.camera.emplace();
    GetParam().change(physics);
    WatchedRig rig(physics, reference_plate(), seed);
    const auto homed = rig.session.home();
    ASSERT_TRUE(homed) << homed.error().text;

    NoiseStream draw(seed, "targets");
    double squares = 0.0, worst_mm = 0.0, worst_late_s = -1.0, worst_camera_um = 0.0, normalised = 0.0;
    for (int i = 0; i < targets; ++i) {
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << seed << ", target " << i);
        const int tag = 1 + static_cast<int>(99.0 * draw.uniform());
        const double dx_mm = 3.0 * (draw.uniform() - 0.5);
        const double target_mm = 2.0 * tag + dx_mm;
        rig.stage->history.clear();
        const auto arrival = rig.session.go_to(tag, dx_mm);
        ASSERT_TRUE(arrival) << name_of(arrival.error().reason) << ": " << arrival.error().text;
        EXPECT_TRUE(arrival->within_tolerance);
        const auto arrived = rig.stage->history.size() - 1;
        const double error_mm = plant::camera_position_mm(rig.stage->history.back()) - target_mm;
        ASSERT_TRUE(rig.session.hold(1.0));

        const auto& history = rig.stage->history;
        const auto ticks = static_cast<std::size_t>(std::lround(arrival->micro_time_s / rig.file.tick_s));
        std::size_t there = history.size();
        while (there > 0 &&
               std::abs(plant::camera_position_mm(history[there - 1]) - target_mm) <= tolerance_mm)
            --there;
        EXPECT_LE(there, arrived) << "left the tolerance after arrival";
        squares += error_mm * error_mm;
        worst_mm = std::max(worst_mm, std::abs(error_mm));
        const double wrong_um = um_from_mm(error_mm) - (arrival->reached_dx_um - arrival->target_dx_um);
        worst_camera_um = std::max(worst_camera_um, std::abs(wrong_um));
        normalised += std::pow(wrong_um / arrival->reached_std_um, 2) / targets;
        if (ticks == 0) continue;
        const std::size_t commanded = arrived - ticks;
        const double limit_s =
            1.1 * bang_bang_s(rig.rig->physics(), history[commanded], target_mm) + 3.0 * frame_period_s;
        const double took_s =
            there > commanded ? rig.file.tick_s * static_cast<double>(there - commanded) : 0.0;
        worst_late_s = std::max(worst_late_s, took_s - limit_s);
        EXPECT_LE(took_s, limit_s);
    }
    const double rms_um = um_from_mm(std::sqrt(squares / targets));
    std::printf(
        "%-14s %d targets: r.m.s. %.2f um, worst %.2f um; slowest %.0f ms before its limit; camera wrong by "
        "%.3f um at most, %.2f of its claim r.m.s.\n",
        GetParam().name, targets, rms_um, um_from_mm(worst_mm), -1e3 * worst_late_s, worst_camera_um,
        std::sqrt(normalised));
    EXPECT_LE(rms_um, 1.0);
    EXPECT_LE(um_from_mm(worst_mm), 5.0);
}

INSTANTIATE_TEST_SUITE_P(
    Slow, Positioning,
    ::testing::Values(
        RigCase{"nominal", [](plant::PlantParameters&) {}, fidservo::testing::draws(200, 60)},
        RigCase{"stroke_up", [](plant::PlantParameters& p) { p.micro->stroke_factor *= 1.05; }},
        RigCase{"stroke_down", [](plant::PlantParameters& p) { p.micro->stroke_factor *= 0.95; }},
        RigCase{"warm_room", [](plant::PlantParameters& p) { p.micro->heater.ambient_degC += 8.0; }},
        RigCase{"cold_room", [](plant::PlantParameters& p) { p.micro->heater.ambient_degC -= 8.0; }},
        RigCase{"hall_gain_up", [](plant::PlantParameters& p) { p.micro->hall.span_V *= 1.02; }},
        RigCase{"hall_gain_down", [](plant::PlantParameters& p) { p.micro->hall.span_V *= 0.98; }},
        RigCase{"late_camera", [](plant::PlantParameters& p) { p.camera->delay_s += 0.03; }},
        RigCase{"all_at_once",
                [](plant::PlantParameters& p) {
                    p.micro->stroke_factor *= 0.95;
                    p.micro->heater.ambient_degC += 8.0;
                    p.micro->hall.span_V *= 1.02;
                    p.camera->delay_s += 0.03;
                },
                fidservo::testing::draws(200, 60)}),
    [](const auto& rig_case) { return std::string(rig_case.param.name); });

}  // namespace
}  // namespace fidservo
