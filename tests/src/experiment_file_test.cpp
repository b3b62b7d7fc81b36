// SPDX-License-Identifier: GPL-3.0-or-later
// Experiments written by users: their commands, tick by tick, and the errors for wrong ones.
#include "src/simulation/experiment_file.h"

#include "core/rig.h"
#include "src/simulation/pieces.h"
#include "src/simulation/simulate.h"
#include "tests/reference_rig.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

Experiment parsed(const std::string& text, const Rig& rig = reference_rig()) {
    return parse_experiment("name: mine\ncarriage_mm: 100\n" + text, "mine.yaml", rig);
}

std::string refusal(const std::string& text, const Rig& rig = reference_rig()) {
    return message_of([&] { (void)parsed(text, rig); });
}

void expect_pieces(const std::string& message, const std::vector<std::string>& pieces) {
    for (const std::string& piece : pieces)
        EXPECT_NE(message.find(piece), std::string::npos) << piece << "\n" << message;
}

TEST(ExperimentFile, Pieces_FollowEachOtherByTheirFormulas) {
    const Experiment experiment = parsed(R"(
macro:
  - { constant_V: 3.5, duration_s: 1 }
  - { ramp_V: [-1, 4], duration_s: 2 }
  - { sine_V: 2, offset_V: 0.5, frequency_hz: 0.25, phase_deg: 90, duration_s: 4 }
  - { hold: last, duration_s: 1 }
)");
    EXPECT_EQ(experiment.kind, "mine");
    EXPECT_EQ(experiment.carriage_mm, 100.0);
    EXPECT_EQ(experiment.duration_s, 8.0);
    EXPECT_FALSE(experiment.macro_setpoint_mm);
    EXPECT_FALSE(experiment.micro_V);
    EXPECT_EQ(experiment.macro_V(0.0), 3.5);
    EXPECT_EQ(experiment.macro_V(0.999), 3.5);
    EXPECT_DOUBLE_EQ(experiment.macro_V(1.0), -1.0);
    EXPECT_DOUBLE_EQ(experiment.macro_V(2.0), 1.5);
    EXPECT_DOUBLE_EQ(experiment.macro_V(3.0), 2.5);
    EXPECT_NEAR(experiment.macro_V(4.0), 0.5, 1e-12);
    EXPECT_NEAR(experiment.macro_V(5.0), -1.5, 1e-12);
    EXPECT_NEAR(experiment.macro_V(7.5), 2.5, 1e-12);
    EXPECT_TRUE(std::isnan(experiment.macro_V(8.0)));
}

TEST(ExperimentFile, MixedCourse_IsEitherSetpointOrVoltage) {
    const Experiment experiment = parsed(R"(
macro:
  - { constant_V: 4, duration_s: 0.2 }
  - { constant_mm: 120, duration_s: 2 }
  - { constant_V: 0, duration_s: 1 }
  - { constant_mm: 110, duration_s: 2 }
)");
    const Recording recording = simulate(reference_rig(), {}, experiment, "mine-1", 3);
    ASSERT_EQ(recording.rows.size(), 5200u);
    EXPECT_EQ(recording.experiment, "mine");
    const auto& rows = recording.rows;
    EXPECT_TRUE(std::isnan(rows[199].macro_setpoint_mm));
    EXPECT_EQ(rows[199].macro_command_V, 4.0);
    EXPECT_EQ(rows[200].macro_setpoint_mm, 120.0);
    EXPECT_NEAR(rows[2199].encoder_count, 2400.0, 2.0);
    EXPECT_TRUE(std::isnan(rows[2200].macro_setpoint_mm));
    EXPECT_EQ(rows[2200].macro_command_V, 0.0);
    EXPECT_NEAR(rows[5199].encoder_count, 2200.0, 2.0);
    // The controller begins anew: e[-1] = 0, so that its first command is e0 e - friction.
    const double error_count = 2200.0 - rows[3200].encoder_count;
    EXPECT_NEAR(rows[3200].macro_command_V, std::max(-5.0, 0.0124593 * error_count - 3.0), 1e-9);
}

TEST(ExperimentFile, BenchmarkPid_IsTheLoopThatItNames) {
    const std::string text = "macro:\n  - { constant_mm: 102, duration_s: 0.5 }\n";
    const Recording pd = simulate(reference_rig(), {}, parsed(text), "a", 3);
    const Recording pid = simulate(reference_rig(), {}, parsed("macro_loop: benchmark_pid\n" + text), "a", 3);
    // u = e (kp + ki T + kd / T) in the first tick, 40 counts; the PD adds 3 V to e0 e.
    const double first_count = 2040.0 - pid.rows[0].encoder_count;
    EXPECT_NEAR(pid.rows[0].macro_command_V,
                std::min(5.0, first_count * (0.03 + 1.0 * 0.001 + 0.0005 / 0.001)), 1e-9);
    EXPECT_NEAR(pd.rows[0].macro_command_V, 3.0 + 0.0124593 * first_count, 1e-9);
}

TEST(ExperimentFile, MicroPieces_HeatAndServo) {
    const Experiment experiment = parsed(R"(
micro:
  - { ramp_V: [1.3, 1.6], duration_s: 2 }
  - { constant_mm: 2.5, duration_s: 3 }
)");
    const Recording recording = simulate(reference_rig(), {}, experiment, "mine-1", 3);
    EXPECT_NEAR(recording.rows[1000].micro_command_V, 1.45, 1e-9);
    EXPECT_EQ(recording.rows[1000].macro_command_V, 0.0);
    EXPECT_NEAR(hall_position_mm_of_adc(reference_rig().micro->hall, recording.rows.back().hall_adc), 2.5,
                0.05);
}

TEST(ExperimentFile, StageWhosePiecesEndEarlier_IsAtZeroFromThenOn) {
    const Experiment experiment = parsed(R"(
macro: [ { constant_V: 3.2, duration_s: 0.1 } ]
micro: [ { constant_V: 1.4, duration_s: 0.3 } ]
)");
    const Recording recording = simulate(reference_rig(), {}, experiment, "mine-1", 3);
    ASSERT_EQ(recording.rows.size(), 300u);
    EXPECT_EQ(recording.rows[99].macro_command_V, 3.2);
    EXPECT_EQ(recording.rows[100].macro_command_V, 0.0);
    EXPECT_EQ(recording.rows[299].micro_command_V, 1.4);
}

TEST(Pieces, ExtremesOfASine_AreThoseOfThePartThatIsRun) {
    const auto sine = [](double frequency_hz, double phase_deg, double duration_s) {
        return extremes({.follows = Follows::setpoint,
                         .duration_s = duration_s,
                         .base = 100.0,
                         .amplitude = 10.0,
                         .omega_rad_per_s = 2.0 * std::numbers::pi * frequency_hz,
                         .phase_rad = phase_deg * std::numbers::pi / 180.0});
    };
    EXPECT_NEAR(sine(1.0, 0.0, 1.0).first, 90.0, 1e-9);
    EXPECT_NEAR(sine(1.0, 0.0, 1.0).second, 110.0, 1e-9);
    EXPECT_NEAR(sine(1.0, 0.0, 0.5).first, 100.0, 1e-9);          // the upper half
    EXPECT_NEAR(sine(1.0, 0.0, 1.0 / 12.0).second, 105.0, 1e-9);  // up to 30 degrees
    EXPECT_NEAR(sine(1.0, -180.0, 0.5).second, 100.0, 1e-9);      // the lower half
    EXPECT_NEAR(sine(1.0, -180.0, 0.5).first, 90.0, 1e-9);
    EXPECT_NEAR(sine(10.0, 77.0, 30.0).second, 110.0, 1e-9);
}

TEST(ExperimentFile, WhatTheRigCannotDo_IsRefusedWithFileLineKeyAndWhatIsAllowed) {
    expect_pieces(refusal("macro: [ { constant_mm: 201, duration_s: 1 } ]"),
                  {"mine.yaml:3:", "macro[0].constant_mm: 201:", "at most 200"});
    expect_pieces(
        refusal("macro:\n  - { constant_V: 1, duration_s: 1 }\n  - { ramp_V: [0, -5.1], duration_s: 1 }"),
        {"mine.yaml:5:", "macro[1].ramp_V[1]: -5.1:", "at least -5"});
    expect_pieces(refusal("macro: [ { sine_mm: 10, offset_mm: 195, frequency_hz: 1, duration_s: 1 } ]"),
                  {"mine.yaml:3:", "macro[0].sine_mm: 10:", "205 mm", "0 to 200"});
    expect_pieces(refusal("macro: [ { sine_V: 3, offset_V: 2.5, frequency_hz: 1, duration_s: 1 } ]"),
                  {"macro[0].sine_V: 3:", "5.5 V", "-5 to 5"});
    expect_pieces(refusal("macro: [ { sine_V: 3, frequency_hz: 500, duration_s: 1 } ]"),
                  {"macro[0].frequency_hz: 500:", "below half the tick rate, 500 Hz"});
    expect_pieces(refusal("micro: [ { constant_V: 1.95, duration_s: 1 } ]"),
                  {"micro[0].constant_V: 1.95:", "at most 1.9"});
    expect_pieces(refusal("micro: [ { constant_V: -0.1, duration_s: 1 } ]"), {"at least 0"});
    expect_pieces(refusal("micro: [ { ramp_mm: [1, 4.1], duration_s: 1 } ]"), {"micro[0].ramp_mm[1]: 4.1:"});
    for (const char* duration : {"0", "-1", "0.0001", "3601"})
        expect_pieces(refusal(fmt::format("macro: [ {{ constant_V: 1, duration_s: {} }} ]", duration)),
                      {"macro[0].duration_s:", duration, "at least 0.001 and at most 3600"});
    expect_pieces(
        message_of(
            [] { (void)parse_experiment("name: a\ncarriage_mm: -1\nmacro: []", "a.yaml", reference_rig()); }),
        {"a.yaml:2: carriage_mm: -1:", "at most 200"});
}

TEST(ExperimentFile, SetpointWithoutController_IsRefused) {
    Rig rig = reference_rig();
    rig.macro.pd.reset();
    const std::string text = "macro: [ { constant_mm: 100, duration_s: 1 } ]";
    expect_pieces(refusal(text, rig), {"macro[0].constant_mm: 100:", "no macro.pd"});
    EXPECT_NO_THROW((void)parsed("macro_loop: benchmark_pid\n" + text, rig));
    rig.micro->pi.reset();
    expect_pieces(refusal("micro: [ { constant_mm: 1, duration_s: 1 } ]", rig), {"no micro.pi"});
    rig.micro.reset();
    expect_pieces(refusal("micro: [ { constant_V: 1, duration_s: 1 } ]", rig),
                  {"micro: a list:", "no micro stage"});
}

TEST(ExperimentFile, WhatIsNoPiece_IsRefused) {
    expect_pieces(refusal("macro: [ { constant_W: 3, duration_s: 1 } ]"),
                  {"constant_W", "did you mean constant_V"});
    expect_pieces(refusal("macro: [ { duration_s: 1 } ]"), {"macro[0]", "constant_V, constant_mm, ramp_V"});
    expect_pieces(refusal("macro: [ { constant_V: 1, ramp_V: [1, 2], duration_s: 1 } ]"), {"one thing only"});
    expect_pieces(refusal("macro: [ { constant_V: 1, frequency_hz: 2, duration_s: 1 } ]"),
                  {"macro[0].frequency_hz: 2:", "does not belong to constant_V"});
    expect_pieces(refusal("macro: [ { sine_V: 1, offset_mm: 2, frequency_hz: 2, duration_s: 1 } ]"),
                  {"does not belong to sine_V"});
    expect_pieces(refusal("macro: [ { sine_mm: 1, frequency_hz: 2, duration_s: 1 } ]"),
                  {"offset_mm: missing"});
    expect_pieces(refusal("macro: [ { constant_V: 1 } ]"), {"macro[0].duration_s: missing"});
    expect_pieces(refusal("macro: [ { hold: last, duration_s: 1 } ]"), {"no piece before"});
    expect_pieces(refusal("macro: []"), {"one piece at least"});
    expect_pieces(refusal(""), {"neither macro nor micro is given"});
    expect_pieces(refusal("macro_loop: pid\nmacro: [ { constant_V: 1, duration_s: 1 } ]"),
                  {"macro_loop: pid:", "nonlinear_pd, benchmark_pid"});
    expect_pieces(refusal("micro_loop: pi"), {"micro_loop", "unknown key"});
    expect_pieces(
        message_of([] { (void)parse_experiment("name: a/b\ncarriage_mm: 1", "a.yaml", reference_rig()); }),
        {"name: a/b:", "letters, digits"});
}

TEST(ExperimentFile, Argument_IsAFileByItsEndingOrWhereOneIs) {
    const TemporaryFolder folder;
    EXPECT_TRUE(is_experiment_file("nowhere.yaml"));
    EXPECT_TRUE(is_experiment_file("nowhere.yml"));
    EXPECT_TRUE(is_experiment_file(folder.write("pieces.txt", "").string()));
    EXPECT_FALSE(is_experiment_file(folder.path().string()));
    EXPECT_FALSE(is_experiment_file("macro-sweep"));
    EXPECT_FALSE(is_experiment_file("campaign"));
}

TEST(ExperimentFile, Simulate_RecordsTheDemo) {
    const TemporaryFolder folder;
    const auto run =
        run_program({"simulate", FIDSERVO_ASSETS_DIR "/demo/slow-ramp.yaml", "--out", "ramp"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string description = text_of(folder / "ramp/recording.yaml");
    expect_pieces(description, {"experiment: slow-ramp", "name: slow-ramp-1"});
    const auto missing = run_program({"simulate", "nowhere.yaml", "--out", "o"}, folder.path());
    EXPECT_EQ(missing.exit_code, 2);
    expect_pieces(missing.err, {"nowhere.yaml", "cannot be opened"});
}

}  // namespace
}  // namespace fidservo
