// SPDX-License-Identifier: GPL-3.0-or-later
// The check of a stage against simulated ones, healthy and not.
#include "control/stage_check.h"

#include "plant/stage_plant.h"
#include "tests/reference_rig.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

using ::testing::HasSubstr;

/// What is wrong between the program and the stage.
struct Fault {
    bool encoder_reversed = false;
    bool encoder_stands = false;
    bool hall_stands = false;
    bool hall_reversed = false;
    double encoder_factor = 1.0;
    std::optional<int> hall_reads = std::nullopt;
};

struct Outcome {
    StageCheckState state;
    double carriage_shift_mm = 0.0;
    TimeNs ticks = 0;
    double warmest_degC = 0.0;
};

/// What the wire has been through when the check begins: heated for two seconds, then left alone.
struct Before {
    double heated_V = 0.0;
    double cooled_s = 0.0;
};

Outcome check(const Fault& fault, double carriage_mm = 100.0, const Before& before = {}) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState stage = plant::start(plant, carriage_mm, 3);
    for (int tick = 0; before.heated_V > 0.0 && tick < 2000; ++tick)
        plant::advance(plant, stage, 0.0, before.heated_V);
    for (double left_s = before.cooled_s; left_s > 0.0; left_s -= plant.tick_s)
        plant::advance(plant, stage, 0.0, 0.0);
    const StageCheckParams params = stage_check_params(reference_rig());
    Outcome outcome;
    const plant::StageReading first = plant::sample(plant, stage);
    while (!stage_check_is_done(outcome.state) && outcome.ticks++ < 30'000) {
        plant::StageReading reading = plant::sample(plant, stage);
        const auto moved = static_cast<double>(reading.encoder_count - first.encoder_count);
        reading.encoder_count = first.encoder_count + std::lround(fault.encoder_factor * moved);
        if (fault.encoder_reversed) reading.encoder_count = -reading.encoder_count;
        if (fault.encoder_stands) reading.encoder_count = first.encoder_count;
        if (fault.hall_stands) reading.hall_adc = first.hall_adc;
        if (fault.hall_reversed) reading.hall_adc = 4096 - reading.hall_adc;
        const StageCommand command = stage_check_update(
            params, outcome.state,
            {outcome.ticks * ns_per_ms, reading.encoder_count, fault.hall_reads.value_or(reading.hall_adc)});
        plant::advance(plant, stage, command.macro_V, command.micro_V);
        outcome.warmest_degC = std::max(outcome.warmest_degC, stage.micro->heater.temp_degC);
    }
    outcome.carriage_shift_mm = stage.axis.position_mm - carriage_mm;
    return outcome;
}

TEST(StageCheck, HealthyStage_PassesAndIsAsBefore) {
    const Outcome outcome = check({});
    EXPECT_EQ(outcome.state.phase, StageCheckPhase::passed) << outcome.state.why;
    EXPECT_NEAR(outcome.state.moved_mm, 2.0, 0.3);
    EXPECT_NEAR(outcome.carriage_shift_mm, 0.0, 0.1);
    EXPECT_LT(outcome.warmest_degC, 105.0);
}

TEST(StageCheck, AtEitherEnd_PassesByThePushThatIsFree) {
    for (const double end_mm : {0.0, 200.0})
        EXPECT_EQ(check({}, end_mm).state.phase, StageCheckPhase::passed) << end_mm;
}

/// As after a run that was killed and is taken up at once.
TEST(StageCheck, WireStillHot_Passes) {
    for (const double heated_V : {1.45, 1.5, 1.55, 1.6, 1.65})
        for (const double cooled_s : {0.0, 0.2, 0.5, 1.0, 2.0}) {
            const Outcome outcome = check({}, 100.0, {heated_V, cooled_s});
            EXPECT_EQ(outcome.state.phase, StageCheckPhase::passed)
                << heated_V << " V, " << cooled_s << " s: " << outcome.state.why;
        }
}

TEST(StageCheck, WhatDoesNotAnswer_IsNamed) {
    const auto why = [](const Fault& fault) {
        const Outcome outcome = check(fault);
        EXPECT_EQ(outcome.state.phase, StageCheckPhase::failed);
        return outcome.state.why;
    };
    EXPECT_THAT(why({.encoder_stands = true}), HasSubstr("encoder does not answer to the motor"));
    EXPECT_THAT(why({.encoder_reversed = true}), HasSubstr("against the motor"));
    EXPECT_THAT(why({.encoder_factor = 10.0}), HasSubstr("at a push that is good for 2.0"));
    EXPECT_THAT(why({.hall_stands = true}), HasSubstr("does not answer to the heater"));
    EXPECT_THAT(why({.hall_reversed = true}), HasSubstr("falls when the wire is heated"));
    EXPECT_THAT(why({.hall_reads = 4095}), HasSubstr("the Hall sensor reads 4095"));
    EXPECT_THAT(why({.hall_reads = 0}), HasSubstr("the Hall sensor reads 0"));
}

TEST(StageCheck, EncoderThatMovesAtRest_IsNotTrusted) {
    const StageCheckParams params = stage_check_params(reference_rig());
    StageCheckState state;
    for (int tick = 0; tick < 100 && !stage_check_is_done(state); ++tick) {
        const StageCommand command = stage_check_update(params, state, {tick * ns_per_ms, tick, 2048});
        EXPECT_EQ(command.macro_V, 0.0);
    }
    EXPECT_THAT(state.why, HasSubstr("moves although the motor is off"));
}

}  // namespace
}  // namespace fidservo::control
