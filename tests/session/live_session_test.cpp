// SPDX-License-Identifier: GPL-3.0-or-later
// The whole session in real time, as on hardware: loop in a thread of its own, a camera that delivers by the
// wall clock, vision in between. The rig is a simulated one that advances in real time, independent of the
// program.
#include "control/stage_check.h"
#include "core/monotonic_clock.h"
#include "core/result.h"
#include "core/rig.h"
#include "core/units.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/record/on_rig.h"
#include "src/record/start.h"
#include "src/session/pilot.h"
#include "src/session/session.h"
#include "src/session/stage_start.h"
#include "src/simulation/experiment_law.h"
#include "tests/live_rig.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

class LiveStage final : public control::Stage {
  public:
    explicit LiveStage(std::shared_ptr<LiveRig> rig) : rig_(std::move(rig)) {}
    Result<control::StageSample> read() override {
        const TimeNs now_ns = monotonic_now_ns();
        const plant::StageReading reading = rig_->read(now_ns);
        return control::StageSample{now_ns, reading.encoder_count, reading.hall_adc};
    }
    Status write(const control::StageCommand& command) override {
        rig_->command(command.macro_V, command.micro_V);
        return {};
    }

  private:
    std::shared_ptr<LiveRig> rig_;
};

class LiveCamera final : public vision::Camera {
  public:
    LiveCamera(std::shared_ptr<LiveRig> rig, const CameraParameters& camera)
        : rig_(std::move(rig)), camera_(camera), start_ns_(monotonic_now_ns()) {}

    Result<std::optional<vision::Frame>> poll(TimeNs now_ns) override {
        const double age_s = seconds(now_ns - start_ns_) - camera_.latency_s;
        const auto frame = static_cast<std::int64_t>(std::floor(age_s * camera_.frame_rate_hz));
        if (frame <= last_) return std::nullopt;
        last_ = frame;
        vision::Frame result;
        result.time_ns = start_ns_ + nanoseconds(static_cast<double>(frame) / camera_.frame_rate_hz);
        result.image = rig_->frame_at(result.time_ns, static_cast<std::uint64_t>(frame));
        result.arrival_ns = monotonic_now_ns();
        result.sequence = static_cast<std::uint64_t>(frame);
        return result;
    }

  private:
    std::shared_ptr<LiveRig> rig_;
    CameraParameters camera_;
    TimeNs start_ns_;
    std::int64_t last_ = 0;
};

/// The reference rig with a coarser and slower image, so that a busy machine keeps up.
Rig live_rig_file() {
    Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    rig.camera->geometry.width_px = 640;
    rig.camera->geometry.height_px = 480;
    rig.camera->geometry.focal_px = 2500.0;
    rig.camera->geometry.principal_point_px = {319.5, 239.5};
    rig.camera->frame_rate_hz = 20.0;
    return rig;
}

TEST(SlowLiveSession, HomeAndGoTo_ReachTheTruthWithinTolerance) {
    const Rig rig = live_rig_file();
    const Plate plate = plate_of(rig.fiducials.value());
    const testing::TemporaryFolder folder;
    const auto live = std::make_shared<LiveRig>(rig, plate, 30.0, 5);
    // The watchdog does not check the time: the machine may be busy, and the loop must be right at any speed.
    const auto loop =
        std::make_shared<control::StageLoop>(std::make_shared<LiveStage>(live), control::LoopOptions{});
    {
        Session session({}, rig, plate,
                        Devices{nullptr, std::make_shared<LiveCamera>(live, *rig.camera), loop});
        check_stage(session.pilot());
        session.record_to(folder.path() / "run", "live");
        const auto homed = session.home();
        ASSERT_TRUE(homed) << homed.error().text;
        EXPECT_NEAR(session.pilot().believed_s_mm(), live->camera_mm(monotonic_now_ns()), 0.05);
        for (const auto& [tag, dx_um] : {std::pair{9, 150.0}, std::pair{12, -40.0}, std::pair{12, 300.0}}) {
            const auto arrival = session.go_to(tag, mm_from_um(dx_um));
            ASSERT_TRUE(arrival) << arrival.error().text << "; the camera is at "
                                 << live->camera_mm(monotonic_now_ns()) << " mm, believed at "
                                 << session.pilot().believed_s_mm() << " mm";
            const double truth_um = um_from_mm(live->camera_mm(monotonic_now_ns()) - 2.0 * tag);
            std::cout << "tag " << tag << ": asked " << dx_um << " um, reached " << arrival->reached_dx_um
                      << " um, truth " << truth_um << " um, " << arrival->micro_moves << " micro moves\n";
            EXPECT_TRUE(arrival->within_tolerance);
            EXPECT_NEAR(truth_um, dx_um, 2.0);
        }
        ASSERT_TRUE(session.end_recording());
        std::cout << "loop: " << text_of(*session.loop_statistics()) << '\n';
        EXPECT_GT(session.loop_statistics()->held, 0U) << "vision took no time?";
    }
    EXPECT_FALSE(loop->ended());
    const Recording recording = read_recording(folder.path() / "run");
    const auto statistics = loop->statistics();
    EXPECT_LE(recording.rows.size(), statistics.ticks);
    EXPECT_GT(recording.rows.size(), statistics.ticks / 2) << "held ticks are rows too";
    for (std::size_t k = 1; k < recording.rows.size(); ++k)
        ASSERT_GT(recording.rows[k].time_ns, recording.rows[k - 1].time_ns) << "row " << k;
}

/// The loop's thread runs the experiment's law: at every tick the command is the law's result for the
/// reading.
TEST(SlowLiveSession, Experiment_EveryCommandAnswersItsReading) {
    const Rig rig = live_rig_file();
    const Plate plate = plate_of(rig.fiducials.value());
    const testing::TemporaryFolder folder;
    const auto live = std::make_shared<LiveRig>(rig, plate, 30.0, 5);
    const auto loop =
        std::make_shared<control::StageLoop>(std::make_shared<LiveStage>(live), control::LoopOptions{});
    const Experiment experiment{.kind = "both-loops",
                                .duration_s = 1.0,
                                .carriage_mm = 12.0,
                                .macro_setpoint_mm = steps({0.0, 0.2}, {12.0, 16.0}),
                                .micro_setpoint_mm = steps({0.0}, {1.0})};
    {
        Session session({}, rig, plate,
                        Devices{nullptr, std::make_shared<LiveCamera>(live, *rig.camera), loop});
        check_stage(session.pilot());
        const auto homed = session.home();
        ASSERT_TRUE(homed) << homed.error().text;
        const auto brought = ExperimentStart(session.pilot()).bring_to(experiment.carriage_mm);
        ASSERT_TRUE(brought) << brought.error().text;
        session.record_to(folder / "run", experiment.kind);
        Progress progress("s", 1);
        const auto end = run_on_rig(session, experiment, progress);
        ASSERT_TRUE(end) << end.error().text;
        EXPECT_EQ(*end, ExperimentEnd::whole);
        ASSERT_TRUE(session.end_recording());
    }
    EXPECT_FALSE(loop->ended());
    const Recording recording = read_recording(folder / "run");
    const double zero_count = std::round(recording.encoder_zero.value().count);
    ExperimentLoops loops;
    std::optional<TimeNs> start_ns;
    int in_force = 0;
    for (const StageRow& row : recording.rows) {
        if (std::isnan(row.macro_setpoint_mm)) continue;  // held before and after the experiment
        if (!start_ns) start_ns = row.time_ns;
        StageRow again = row;
        command_tick(rig, experiment, zero_count, seconds(row.time_ns - *start_ns), loops, again);
        ASSERT_NEAR(row.macro_command_V, again.macro_command_V, 1e-7) << in_force;
        ASSERT_NEAR(row.micro_command_V, again.micro_command_V, 1e-7) << in_force;
        ++in_force;
    }
    EXPECT_LE(in_force, 1000);
    EXPECT_GT(in_force, 500) << "a busy machine may leave out some";
    EXPECT_EQ(recording.rows.back().macro_command_V, 0.0);
}

}  // namespace
}  // namespace fidservo
