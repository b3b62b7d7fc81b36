// SPDX-License-Identifier: GPL-3.0-or-later
// The supervisor on the simulated stage, without images: the camera reports the truth with noise and a delay.
#include "control/positioner.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "core/rig.h"
#include "plant/stage_plant.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

PositionerParams positioner_params(const Rig& rig) {
    PositionerParams params;
    params.macro = {*rig.macro.pd, rig.macro.command_limit_V, rig.tick_s};
    params.micro = {nominal_micro_model(*rig.micro), *rig.micro->pi, rig.tick_s, {}};
    params.count_mm = rig.macro.encoder_resolution_mm;
    params.reach_low_mm = 0.2;
    params.reach_high_mm = 3.8;
    params.park_low_mm = 1.0;
    params.park_high_mm = 3.0;
    return params;
}

constexpr CarriageTravel anywhere{-1e5, 1e5};

/// The stage, and a camera whose frames report the distance to a target.
class Bench {
  public:
    Bench(const Rig& rig, std::uint64_t seed, double start_mm)
        : stage_(plant::make_stage_plant(rig)),
          truth_(plant::start(stage_, start_mm, seed)),
          noise_(seed, "camera") {}

    double position_mm() const { return plant::camera_position_mm(truth_); }
    const plant::StageState& truth() const { return truth_; }
    const plant::StagePlant& stage() const { return stage_; }

    /// One tick of the loop. @return the command applied
    StageCommand tick(const PositionerParams& params, PositionerState& state, double target_mm) {
        const TimeNs now = tick_ * ns_per_ms;
        constexpr TimeNs period = 20 * ns_per_ms, latency = 30 * ns_per_ms;
        if (now % period == 3 * ns_per_ms)
            in_flight_.push_back(
                {now, target_mm - position_mm() + camera_std_mm * noise_.normal(), camera_std_mm});
        std::optional<TargetOffset> seen;
        if (!in_flight_.empty() && in_flight_.front().time_ns + latency <= now) {
            seen = in_flight_.front();
            in_flight_.pop_front();
        }
        const auto reading = plant::sample(stage_, truth_);
        const auto out =
            positioner_update(params, state, {now, reading.encoder_count, reading.hall_adc}, seen);
        plant::advance(stage_, truth_, out.command.macro_V, out.command.micro_V);
        ++tick_;
        return out.command;
    }

  private:
    static constexpr double camera_std_mm = 0.0002;
    plant::StagePlant stage_;
    plant::StageState truth_;
    NoiseStream noise_;
    std::deque<TargetOffset> in_flight_;
    TimeNs tick_ = 0;
};

TEST(Positioner, RandomTargetsOverThePlate_EndWithinToleranceAndStay) {
    const Rig& rig = reference_rig();
    const PositionerParams params = positioner_params(rig);
    Bench bench(rig, 1, 20.0);
    PositionerState state = positioner_start(params);
    NoiseStream targets(1, "targets");
    double squares = 0.0;
    constexpr int n = 100;
    for (int i = 0; i < n; ++i) {
        SCOPED_TRACE(::testing::Message() << "seed 1, target " << i);
        const double target_mm = i % 3 == 0 ? bench.position_mm() + 0.2 * (targets.uniform() - 0.5)
                                            : 4.0 + 192.0 * targets.uniform();
        positioner_begin(params, state, target_mm - bench.position_mm() + 0.02 * targets.normal(), anywhere);
        int ticks = 0;
        while (!positioner_is_done(state) && ticks++ < 20'000) bench.tick(params, state, target_mm);
        ASSERT_EQ(state.phase, PositionerPhase::arrived) << name_of(state.why);
        for (int k = 0; k < 1000; ++k) {
            bench.tick(params, state, target_mm);
            ASSERT_LT(std::abs(bench.position_mm() - target_mm), 0.005);
        }
        squares += std::pow(bench.position_mm() - target_mm, 2);
    }
    EXPECT_LT(std::sqrt(squares / n), 0.0015);
}

/// Steps that reverse the last move, 0.1 to 0.2 mm: the published PI alone hunts there, the hold does not.
double unrest_mm(const Rig& rig, bool published_pi_alone) {
    const PositionerParams params = positioner_params(rig);
    const plant::StagePlant stage = plant::make_stage_plant(rig);
    plant::StageState truth = plant::start(stage, 50.0, 3);
    MicroControllerState shaped = micro_start(params.micro);
    PiState pi = pi_start(params.micro.pi);
    double setpoint_mm = 2.0, worst_mm = 0.0;
    for (int step = 0; step < 12; ++step) {
        setpoint_mm += step % 2 == 0 ? 0.15 : -0.15;
        double low = 1e9, high = -1e9;
        for (int k = 0; k < 6000; ++k) {
            const double adc = plant::sample(stage, truth).hall_adc;
            if (k == 0 && !published_pi_alone) micro_begin_move(params.micro, shaped, setpoint_mm);
            const double error_mm = setpoint_mm - platform_position_mm(params.micro.model, adc);
            const double command_V = published_pi_alone ? pi_update(params.micro.pi, rig.tick_s, pi, error_mm)
                                                        : micro_update(params.micro, shaped, adc);
            plant::advance(stage, truth, 0.0, command_V);
            if (k < 2000) continue;
            low = std::min(low, truth.micro->position_mm);
            high = std::max(high, truth.micro->position_mm);
        }
        worst_mm = std::max(worst_mm, high - low);
    }
    return worst_mm;
}

TEST(MicroController, ReversingSteps_EndTheHuntingOfThePublishedPi) {
    const Rig& rig = reference_rig();
    EXPECT_GT(unrest_mm(rig, true), 0.020);
    EXPECT_LT(unrest_mm(rig, false), 0.001);
}

TEST(Positioner, MicroStageMovesOnlyAfterTheMacroStageHasSettled) {
    const Rig& rig = reference_rig();
    const PositionerParams params = positioner_params(rig);
    Bench bench(rig, 2, 20.0);
    PositionerState state = positioner_start(params);
    positioner_begin(params, state, 60.0, anywhere);
    double moved_V = 0.0;
    while (!positioner_is_done(state)) {
        const double micro_before = state.micro.command_V;
        const StageCommand command = bench.tick(params, state, 80.0);
        const bool micro_moves = state.phase == PositionerPhase::micro_move;
        ASSERT_FALSE(micro_moves && command.macro_V != 0.0);
        if (!micro_moves && state.phase != PositionerPhase::micro_settle)
            moved_V = std::max(moved_V, std::abs(command.micro_V - micro_before));
    }
    EXPECT_EQ(state.phase, PositionerPhase::arrived);
    EXPECT_LT(moved_V, 0.7);
    EXPECT_GT(state.macro_s, 0.0);
    EXPECT_GT(state.micro_s, 0.0);
}

TEST(Positioner, FramesExposedBeforeTheRest_AreNotUsed) {
    const Rig& rig = reference_rig();
    const PositionerParams params = positioner_params(rig);
    PositionerState state = positioner_start(params);
    positioner_begin(params, state, 0.5, anywhere);
    TimeNs now = 0;
    while (state.phase != PositionerPhase::look)
        positioner_update(params, state, {now += ns_per_ms, 0, 1024}, {});
    const TimeNs rest = now;
    for (int k = 0; k < 5; ++k)
        positioner_update(params, state, {now += ns_per_ms, 0, 1024},
                          TargetOffset{rest - k * ns_per_ms - 1, 0.0, 1e-4});
    EXPECT_EQ(state.frames, 0);
    EXPECT_EQ(state.phase, PositionerPhase::look);
}

TEST(Positioner, FramesThatDisagree_NeverConfirmARest) {
    const Rig& rig = reference_rig();
    const PositionerParams params = positioner_params(rig);
    PositionerState state = positioner_start(params);
    positioner_begin(params, state, 0.5, anywhere);
    TimeNs now = 0;
    double drift_mm = 0.0;
    while (!positioner_is_done(state)) {
        now += ns_per_ms;
        std::optional<TargetOffset> seen;
        if (now % (20 * ns_per_ms) == 0) seen = TargetOffset{now, drift_mm += 0.01, 1e-4};
        positioner_update(params, state, {now, 0, 1024}, seen);
    }
    EXPECT_EQ(state.phase, PositionerPhase::failed);
    EXPECT_EQ(state.why, Reason::not_at_rest);
}

TEST(Positioner, LooksOfUnequalPrecision_AreWeighedByTheirInverseVariances) {
    const TargetOffset rough{10, 0.0010, 0.0003}, fine{20, 0.0012, 0.0001};
    const TargetOffset both = combine_looks(rough, fine);
    EXPECT_EQ(both.time_ns, 20);
    EXPECT_NEAR(both.needed_mm, (1.0 * 0.0010 + 9.0 * 0.0012) / 10.0, 1e-12);
    EXPECT_NEAR(both.std_mm, 0.0003 / std::sqrt(10.0), 1e-12);
}

TEST(Positioner, LooksThatDifferByMoreThanTheyClaim_WeighAlikeAndWidenTheResult) {
    const TargetOffset before{10, 0.0, 1e-7}, now{20, 0.0002, 3e-7};
    const TargetOffset both = combine_looks(before, now);
    EXPECT_NEAR(both.needed_mm, 0.0001, 1e-8);
    EXPECT_NEAR(both.std_mm, 0.0001, 1e-7);  // half their difference, as for a mean of two draws
}

TEST(Positioner, LooksOfKnownNoise_ClaimWhatTheyAreWrongBy) {
    constexpr std::uint64_t seed = 31;
    NoiseStream noise(seed, "looks");
    for (const double shake_mm : {0.0, 0.00005}) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", shake " << shake_mm);
        double squares = 0.0;
        constexpr int draws = 20'000;
        for (int k = 0; k < draws; ++k) {
            const double first_mm = 1e-5 * (1.0 + noise.uniform()),
                         second_mm = 1e-5 * (1.0 + noise.uniform());
            const auto at = [&](double std_mm) { return noise.normal() * std::hypot(std_mm, shake_mm); };
            const TargetOffset both =
                combine_looks({0, at(first_mm), first_mm}, {1, at(second_mm), second_mm});
            squares += std::pow(std::clamp(both.needed_mm / both.std_mm, -10.0, 10.0), 2);
        }
        const double normalised = std::sqrt(squares / draws);
        EXPECT_GT(normalised, 0.75);
        // One difference determines the size of the shaking poorly, hence the heavy tails above 1.
        EXPECT_LT(normalised, shake_mm > 0.0 ? 2.5 : 1.0);
    }
}

TEST(Positioner, NoTagInView_FailsWithinItsTime) {
    const Rig& rig = reference_rig();
    const PositionerParams params = positioner_params(rig);
    PositionerState state = positioner_start(params);
    positioner_begin(params, state, 0.5, anywhere);
    TimeNs now = 0;
    while (!positioner_is_done(state) && now < 2 * ns_per_s)
        positioner_update(params, state, {now += ns_per_ms, 0, 1024}, {});
    EXPECT_EQ(state.phase, PositionerPhase::failed);
    EXPECT_EQ(state.why, Reason::no_tag);
    EXPECT_LT(now, ns_per_s);
}

}  // namespace
}  // namespace fidservo::control
