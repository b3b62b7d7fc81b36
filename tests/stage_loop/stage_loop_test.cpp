// SPDX-License-Identifier: GPL-3.0-or-later
// The loop's thread on a stage in memory: the records that it hands over, what it does without a program, and
// how it ends. Nothing here depends on the machine's speed.
#include "control/stage_loop.h"

#include "control/positioner.h"
#include "core/failure.h"
#include "core/monotonic_clock.h"
#include "core/result.h"
#include "core/rig.h"
#include "plant/stage_plant.h"
#include "src/files/rig/rig_file.h"
#include "src/session/motion_params.h"
#include "tests/plant/allocation_count.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class MemoryStage final : public Stage {
  public:
    Result<StageSample> read() override {
        if (fails) return failure(Reason::device, "the wire is cut");
        return StageSample{0, ++reads_, 2048};
    }
    Status write(const StageCommand& command) override {
        macro_V = command.macro_V;
        micro_V = command.micro_V;
        return {};
    }

    std::atomic<bool> fails{false};
    std::atomic<double> macro_V{-1.0}, micro_V{-1.0};

  private:
    std::int64_t reads_ = 0;
};

/// Gives a command for some ticks.
struct Ramp {
    int ticks;
    double micro_V;
    int given = 0;

    static LoopStep tick(void* self, const StageSample&) {
        auto& ramp = *static_cast<Ramp*>(self);
        return {{0.0, ramp.micro_V}, 1.5, 2.5, ++ramp.given == ramp.ticks};
    }
    LoopProgram program() { return {this, &Ramp::tick}; }
};

void run(StageLoop& loop, const LoopProgram& program) {
    loop.start(program);
    while (loop.running()) loop.wait(100ms);
}

TEST(StageLoop, Program_RunsItsTicksAndItsLastCommandStays) {
    auto stage = std::make_shared<MemoryStage>();
    StageLoop loop(stage, {});
    Ramp ramp{50, 1.4};
    run(loop, ramp.program());
    EXPECT_EQ(ramp.given, 50);
    const std::uint64_t held_by_then = loop.statistics().held;
    while (loop.statistics().held < held_by_then + 21) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(stage->micro_V, 1.4);
    EXPECT_EQ(ramp.given, 50) << "a program that is done is not called again";

    int own = 0, held_after = 0;
    std::int64_t last_read = 0;
    TimeNs last_ns = 0;
    while (const auto record = loop.next()) {
        EXPECT_EQ(record->sample.encoder_count, last_read + 1) << "a tick is missing";
        EXPECT_GT(record->sample.time_ns, last_ns);
        last_read = record->sample.encoder_count;
        last_ns = record->sample.time_ns;
        if (record->held) {
            held_after += own == 50 ? 1 : 0;
            EXPECT_EQ(record->step.command.micro_V, own == 0 ? 0.0 : 1.4);
        } else {
            ++own;
            EXPECT_EQ(record->step.done, own == 50);
            EXPECT_EQ(record->step.macro_setpoint_mm, 1.5);
        }
    }
    EXPECT_EQ(own, 50);
    EXPECT_GE(held_after, 20);
    EXPECT_TRUE(loop.stop());
    EXPECT_EQ(stage->micro_V, 0.0);
}

TEST(StageLoop, SamplesTimes_AreWholePeriodsApart) {
    StageLoop loop(std::make_shared<MemoryStage>(), {});
    Ramp ramp{30, 1.0};
    run(loop, ramp.program());
    std::optional<TimeNs> first_ns;
    while (const auto record = loop.next()) {
        if (!first_ns) first_ns = record->sample.time_ns;
        EXPECT_EQ((record->sample.time_ns - *first_ns) % ns_per_ms, 0);
    }
}

/// A stage that keeps its reader waiting for two and a half periods, now and then.
class StallingStage final : public Stage {
  public:
    explicit StallingStage(TimeNs period_ns) : period_ns_(period_ns) {}

    Result<StageSample> read() override {
        ++reads_;
        read_ns.push_back(monotonic_now_ns());
        if (reads_ % 3 == 0) {
            const TimeNs until_ns = read_ns.back() + 5 * period_ns_ / 2;
            std::this_thread::sleep_for(std::chrono::nanoseconds(until_ns - monotonic_now_ns()));
        }
        return StageSample{0, reads_, 2048};
    }
    Status write(const StageCommand&) override { return {}; }

    std::vector<TimeNs> read_ns;  ///< the loop thread's own until the loop has stopped

  private:
    TimeNs period_ns_;
    std::int64_t reads_ = 0;
};

TEST(StageLoop, LateByTicks_GoesOnAtAWholeOne) {
    constexpr TimeNs period_ns = 20 * ns_per_ms;
    const auto stage = std::make_shared<StallingStage>(period_ns);
    LoopOptions options;
    options.tick_s = seconds(period_ns);
    StageLoop loop(stage, options);
    Ramp ramp{10, 1.0};
    run(loop, ramp.program());
    ASSERT_TRUE(loop.stop());
    std::vector<TimeNs> row_ns;
    while (const auto record = loop.next()) row_ns.push_back(record->sample.time_ns);
    ASSERT_GE(row_ns.size(), 10U);
    for (std::size_t k = 3; k < row_ns.size(); k += 3)
        EXPECT_GE(row_ns[k], stage->read_ns[k - 1] + 5 * period_ns / 2) << "of a time before it was read";
    EXPECT_GE(loop.statistics().overruns, 2 * (row_ns.size() / 3 - 1));
}

TEST(StageLoop, StageFails_ProgramEndsWithTheReasonAndZero) {
    auto stage = std::make_shared<MemoryStage>();
    StageLoop loop(stage, {});
    Ramp ramp{1'000'000, 1.4};
    loop.start(ramp.program());
    while (loop.statistics().ticks < 10) std::this_thread::sleep_for(1ms);
    stage->fails = true;
    while (loop.running()) loop.wait(100ms);
    ASSERT_TRUE(loop.ended());
    EXPECT_EQ(loop.ended()->reason, Reason::device);
    EXPECT_THAT(loop.ended()->text, HasSubstr("the wire is cut"));
    EXPECT_EQ(stage->micro_V, 0.0);
    const int given = ramp.given;
    stage->fails = false;
    Ramp another{5, 1.4};
    run(loop, another.program());
    EXPECT_EQ(another.given, 0) << "the end is for good";
    EXPECT_EQ(ramp.given, given);
    EXPECT_EQ(stage->micro_V, 0.0);
}

std::atomic<bool> somebody_wants_to_stop{false};
bool stop_wanted() noexcept {
    return somebody_wants_to_stop;
}

TEST(StageLoop, SomebodyAsksToStop_ZeroAlsoWithoutAProgram) {
    somebody_wants_to_stop = false;
    auto stage = std::make_shared<MemoryStage>();
    StageLoop loop(stage, {.watchdog = {}, .stop_requested = stop_wanted});
    Ramp ramp{5, 1.4};
    run(loop, ramp.program());
    EXPECT_EQ(stage->micro_V, 1.4);
    somebody_wants_to_stop = true;
    while (!loop.ended()) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(loop.ended()->reason, Reason::stopped);
    EXPECT_EQ(stage->micro_V, 0.0);
}

TEST(StageLoop, NobodyTakesTheTicks_EndsRatherThanLoseThem) {
    auto stage = std::make_shared<MemoryStage>();
    StageLoop loop(stage, {.watchdog = {}, .ring_s = 0.032});
    while (!loop.ended()) std::this_thread::sleep_for(1ms);
    EXPECT_THAT(loop.ended()->text, HasSubstr("nobody took the loop's samples"));
    std::int64_t taken = 0;
    while (const auto record = loop.next()) EXPECT_EQ(record->sample.encoder_count, ++taken);
    EXPECT_EQ(taken, 32);
}

TEST(StageLoop, WatchdogsAlarm_EndsWithItsWords) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    auto stage = std::make_shared<MemoryStage>();
    LoopOptions options;
    options.watchdog = watchdog_params(rig);
    options.watchdog->late_ticks = 1'000'000;  // a busy machine is no reason here
    StageLoop loop(stage, options);
    Ramp hot{1'000'000, 1.9};
    run(loop, hot.program());
    ASSERT_TRUE(loop.ended());
    EXPECT_EQ(loop.ended()->reason, Reason::device);
    EXPECT_THAT(loop.ended()->text, HasSubstr("too high for too long"));
    EXPECT_EQ(stage->micro_V, 0.0);
}

/// All that a tick does on the way of a motion: positioner, watchdog, record.
TEST(StageLoop, MotionOfTheWholeStage_DoesNotAllocate) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    const plant::StagePlant plant = plant::make_stage_plant(rig);
    plant::StageState stage = plant::start(plant, 100.0, 1);
    const PositionerParams params = positioner_params(rig, 0.001);
    PositionerState state = positioner_start(params);
    const WatchdogParams watched = watchdog_params(rig);
    WatchdogState watchdog = watchdog_start(watched);
    SpscRing<TickRecord> ring(16384);
    for (int warm = 0; warm < 50; ++warm) {
        const auto reading = plant::sample(plant, stage);
        (void)positioner_update(params, state, {0, reading.encoder_count, reading.hall_adc}, {});
        plant::advance(plant, stage, 0.0, 0.0);
    }
    long alarms = 0;
    const long before = plant::allocation_count();
    for (const double way_mm : {20.3, 0.4, -0.2, -12.7}) {
        positioner_begin(params, state, way_mm, {-10'000.0, 10'000.0});
        StageCommand command;
        for (TimeNs tick = 0; tick < 3000; ++tick) {
            const auto reading = plant::sample(plant, stage);
            const StageSample sample{tick * ns_per_ms, reading.encoder_count, reading.hall_adc};
            alarms += watchdog_update(watched, watchdog, {sample, command, 0, true, {}}) != Alarm::none;
            std::optional<TargetOffset> seen;
            if (state.phase == PositionerPhase::look && tick % 20 == 0)
                seen = TargetOffset{sample.time_ns, 0.05, 0.0001};
            command = positioner_update(params, state, sample, seen).command;
            (void)ring.push({sample, {command, 0.0, 0.0, false}, false});
            plant::advance(plant, stage, command.macro_V, command.micro_V);
        }
    }
    EXPECT_EQ(plant::allocation_count() - before, 0);
    EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace fidservo::control
