// SPDX-License-Identifier: GPL-3.0-or-later
// Experiments on a rig that is homed, brought to their start and driven by the program's own loop; frames are
// rendered and the detector finds what is in them.
#include "src/record/on_rig.h"

#include "core/rig.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "src/record/start.h"
#include "src/session/pilot.h"
#include "src/simulation/experiment_law.h"
#include "src/simulation/simulate.h"
#include "tests/session/watched_rig.h"
#include "tests/src/temporary_folder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::TemporaryFolder;

Experiment open_loop() {
    return {.kind = "open-loop",
            .duration_s = 1.5,
            .carriage_mm = 30.0,
            .macro_V = steps({0.0, 0.2, 0.6, 0.8}, {3.8, 0.0, -4.1, 0.0}),
            .micro_V = steps({0.0, 0.9, 1.2}, {0.0, 1.6, 0.0})};
}

Experiment closed_loop() {
    return {.kind = "closed-loop",
            .duration_s = 1.2,
            .carriage_mm = 31.0,
            .macro_setpoint_mm = steps({0.0, 0.3}, {31.0, 33.0})};
}

/// Homes a rig, brings it to the start, runs an experiment, and keeps the recording.
struct OnRig {
    explicit OnRig(const plant::PlantParameters& physics) : watched(physics, reference_plate(), 5) {
        const auto homed = watched.session.home();
        EXPECT_TRUE(homed) << homed.error().text;
        start.emplace(watched.session.pilot());
    }

    Result<ExperimentEnd> record(const Experiment& experiment, const std::filesystem::path& folder) {
        const auto brought = start->bring_to(experiment.carriage_mm);
        if (!brought) return forward(brought.error());
        EXPECT_EQ(*brought, "");
        begin = watched.rig->truth();
        RecordingOptions options;
        options.name = experiment.kind + "-1";
        options.experiment = experiment.kind;
        options.controllers = controllers_of(experiment);
        watched.session.record_to(folder, options);
        Progress progress("s", 1);
        auto end = run_on_rig(watched.session, experiment, progress);
        start->heater_was_on();
        if (end && *end == ExperimentEnd::whole)
            EXPECT_TRUE(watched.session.end_recording());
        else
            watched.session.leave_recording();
        return end;
    }

    WatchedRig watched;
    std::optional<ExperimentStart> start;
    plant::StageState begin;  ///< true state when the last experiment began
};

/// Compares row by row: the same commands, and the carriage within two counts of that in simulate, which
/// begins exactly at the place and at time 0.
void expect_as_simulated(const Recording& recording, const Experiment& experiment, const Rig& rig) {
    const Recording simulated = simulate(rig, {}, experiment, recording.name, 5);
    ASSERT_EQ(recording.rows.size(), simulated.rows.size() + 1) << "and one that switches off";
    ASSERT_TRUE(recording.encoder_zero);
    const double zero_count = recording.encoder_zero->count;
    for (std::size_t k = 0; k < simulated.rows.size(); ++k) {
        const StageRow &row = recording.rows[k], &same = simulated.rows[k];
        ASSERT_EQ(row.time_ns - recording.rows[0].time_ns, same.time_ns);
        ASSERT_NEAR(row.encoder_count - zero_count, same.encoder_count, 2.0) << k;
        if (!experiment.macro_setpoint_mm) {
            ASSERT_NEAR(row.macro_command_V, same.macro_command_V, 1e-7) << k;
        }
        ASSERT_NEAR(row.micro_command_V, same.micro_command_V, 1e-7) << k;
        ASSERT_EQ(std::isnan(row.macro_setpoint_mm), std::isnan(same.macro_setpoint_mm));
        if (experiment.macro_setpoint_mm) {
            ASSERT_NEAR(row.macro_setpoint_mm, same.macro_setpoint_mm, 1e-4);
        }
    }
    EXPECT_EQ(recording.rows.back().macro_command_V, 0.0);
    EXPECT_EQ(recording.rows.back().micro_command_V, 0.0);
}

TEST(SlowRecordOnRig, ExperimentsInTurn_AreThoseOfSimulate) {
    const TemporaryFolder folder;
    OnRig rig(reference_physics());
    for (const Experiment& experiment : {open_loop(), closed_loop()}) {
        SCOPED_TRACE(experiment.kind);
        const auto end = rig.record(experiment, folder / experiment.kind);
        ASSERT_TRUE(end) << end.error().text;
        EXPECT_EQ(*end, ExperimentEnd::whole);
        EXPECT_NEAR(rig.begin.axis.position_mm, experiment.carriage_mm, 0.075) << "within a count and a half";
        EXPECT_NEAR(rig.begin.micro->heater.temp_degC, 22.0, 0.5) << "cold";
        const Recording recording = read_recording(folder / experiment.kind);
        EXPECT_EQ(recording.name, experiment.kind + "-1");
        EXPECT_FALSE(recording.is_unfinished);
        EXPECT_EQ(recording.controllers.has_value(), experiment.kind == "closed-loop");
        expect_as_simulated(recording, experiment, rig.watched.file);
        EXPECT_GT(recording.detections.size(), 40u);
        const double truth_count = -static_cast<double>(rig.watched.rig->truth().encoder.origin_count);
        EXPECT_NEAR(recording.encoder_zero->count, truth_count, 4.0 * recording.encoder_zero->std_count);
    }
}

TEST(SlowRecordOnRig, CarriageThatGoesFartherThanTheFileSays_IsBrokenOffBeforeTheEnd) {
    const TemporaryFolder folder;
    plant::PlantParameters physics = reference_physics();
    physics.axis.velocity_gain_mm_per_s_per_V *= 1.3;
    OnRig rig(physics);
    const Experiment towards_the_end{
        .kind = "towards-the-end", .duration_s = 3.0, .carriage_mm = 12.0, .macro_V = steps({0.0}, {-3.3})};
    const auto end = rig.record(towards_the_end, folder / "a");
    ASSERT_TRUE(end) << end.error().text;
    EXPECT_EQ(*end, ExperimentEnd::end_of_travel);
    const Recording recording = read_recording(folder / "a");
    EXPECT_TRUE(recording.is_unfinished);
    ASSERT_FALSE(recording.events.empty());
    EXPECT_EQ(recording.events.back().what, "end_of_travel");
    EXPECT_EQ(recording.rows.back().macro_command_V, 0.0);
    ASSERT_TRUE(rig.watched.session.hold(0.3));
    EXPECT_NEAR(rig.watched.rig->truth().axis.position_mm, 0.5, 0.4) << "it coasted to rest before the end";
    const auto placed = rig.start->bring_to(20.0);
    ASSERT_TRUE(placed) << placed.error().text << ": the rig goes on";
}

}  // namespace
}  // namespace fidservo
