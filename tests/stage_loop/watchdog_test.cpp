// SPDX-License-Identifier: GPL-3.0-or-later
// Each alarm is raised by its cause, and none by a healthy stage.
#include "control/watchdog.h"

#include "plant/stage_plant.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

using ::testing::HasSubstr;

constexpr int middle_adc = 2048;

/// Ticks the same input until an alarm; the number of ticks that it took.
struct Watched {
    WatchdogParams params = watchdog_params(reference_rig());
    WatchdogState state = watchdog_start(params);
    WatchdogInput input{{0, 0, middle_adc}, {}, 0, true, {}};
    Alarm alarm = Alarm::none;

    int ticks_to_alarm(int most, std::int64_t counts_per_tick = 0) {
        for (int tick = 1; tick <= most; ++tick) {
            input.sample.encoder_count += counts_per_tick;
            alarm = watchdog_update(params, state, input);
            if (alarm != Alarm::none) return tick;
        }
        return 0;
    }
    std::string text() const { return text_of(alarm, params, state, input); }
};

/// A stage that is driven to and fro and heated up and down, near the limits.
TEST(Watchdog, HealthyStage_NoAlarm) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState stage = plant::start(plant, 100.0, 1);
    const WatchdogParams params = watchdog_params(reference_rig());
    WatchdogState state = watchdog_start(params);
    StageCommand command;
    for (int tick = 0; tick < 60'000; ++tick) {
        const plant::StageReading reading = plant::sample(plant, stage);
        const WatchdogInput input{{0, reading.encoder_count, reading.hall_adc}, command, 0, true, {}};
        const Alarm alarm = watchdog_update(params, state, input);
        ASSERT_EQ(alarm, Alarm::none) << "tick " << tick << ": " << text_of(alarm, params, state, input);
        command = {4.9 * std::sin(2.0 * std::numbers::pi * tick / 700.0), tick % 4000 < 2000 ? 1.62 : 1.3};
        plant::advance(plant, stage, command.macro_V, command.micro_V);
    }
}

TEST(Watchdog, LoopLateByTheLimit_Late) {
    Watched watched;
    watched.input.ticks_late = 19;
    EXPECT_EQ(watched.ticks_to_alarm(100), 0);
    watched.input.ticks_late = 20;
    EXPECT_EQ(watched.ticks_to_alarm(1), 1);
    EXPECT_EQ(watched.alarm, Alarm::late);
    EXPECT_THAT(watched.text(), HasSubstr("late by 20 ticks"));
}

TEST(Watchdog, MotorOnAndNobodyControls_Unattended) {
    Watched watched;
    watched.input.attended = false;
    EXPECT_EQ(watched.ticks_to_alarm(1000), 0) << "the motor is off";
    watched.input.command.macro_V = 1.0;  // in the dead zone: nothing else is wrong
    EXPECT_EQ(watched.ticks_to_alarm(1000), 20);
    EXPECT_EQ(watched.alarm, Alarm::unattended);
}

TEST(Watchdog, HallAtARail_AlarmAfter50Ticks) {
    for (const int adc : {0, 4095}) {
        Watched watched;
        watched.input.sample.hall_adc = adc;
        EXPECT_EQ(watched.ticks_to_alarm(1000), 50) << adc;
        EXPECT_EQ(watched.alarm, Alarm::hall);
        EXPECT_THAT(watched.text(), HasSubstr("Hall sensor reads " + std::to_string(adc)));
    }
}

/// At 1.9 V the model's wire goes to 22 + 163.2 degC with 0.55 s: it passes 135 degC after
/// -0.55 ln(1 - 113/163.2) = 0.648 s.
TEST(Watchdog, FullHeat_OverheatedWhenTheModelSays) {
    Watched watched;
    watched.input.command.micro_V = 1.9;
    ASSERT_DOUBLE_EQ(watched.params.wire_limit_degC, 135.0);
    EXPECT_NEAR(watched.ticks_to_alarm(10'000), 648, 2);
    EXPECT_EQ(watched.alarm, Alarm::overheated);
    EXPECT_THAT(watched.text(), HasSubstr("135 degC"));
}

/// At 5 V the carriage should do V = 0.364 + 0.636 * 2 = 1.636 V times 198.85 mm/s/V = 325 mm/s. The lead of
/// a carriage that stands reaches 30 mm after about 0.18 s (leaky with 0.25 s).
TEST(Watchdog, CarriageStandsAtFullCommand_NotFollowing) {
    Watched watched;
    watched.input.command.macro_V = 5.0;
    const int ticks = watched.ticks_to_alarm(1000);
    EXPECT_GT(ticks, 100);
    EXPECT_LT(ticks, 200);
    EXPECT_EQ(watched.alarm, Alarm::not_following);
    EXPECT_THAT(watched.text(), HasSubstr("farther up"));
}

TEST(Watchdog, CarriageRunsAgainstItsCommand_SoonerThanOneThatStands) {
    Watched standing, running;
    standing.input.command.macro_V = running.input.command.macro_V = -5.0;
    const int until_standing_is_known = standing.ticks_to_alarm(1000);
    const int until_running_is_known = running.ticks_to_alarm(1000, +6);  // 300 mm/s
    EXPECT_GT(until_running_is_known, 0);
    EXPECT_LT(until_running_is_known, until_standing_is_known);
    EXPECT_EQ(running.alarm, Alarm::not_following);
}

TEST(Watchdog, BeyondTravel_OnlyOnceItIsKnown) {
    Watched watched;
    watched.input.sample.encoder_count = 4041;
    EXPECT_EQ(watched.ticks_to_alarm(10), 0);
    watched.input.travel = CarriageTravel{0.0, 4000.0};
    EXPECT_EQ(watched.ticks_to_alarm(10), 1) << "2 mm are 40 counts";
    EXPECT_EQ(watched.alarm, Alarm::beyond_travel);
    watched.input.sample.encoder_count = 4040;
    EXPECT_EQ(watched.ticks_to_alarm(10), 0);
}

}  // namespace
}  // namespace fidservo::control
