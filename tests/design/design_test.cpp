// SPDX-License-Identifier: GPL-3.0-or-later
// Designed experiments as pieces: what is written is what is commanded, and within what the rig allows.
#include "src/design/design.h"

#include "core/random.h"
#include "core/rig.h"
#include "src/design/starts.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo::design {
namespace {

/// What a stage is told, by the pieces' definition (docs/formats.md); not in force where another unit is.
double told(const std::vector<DesignedPiece>& pieces, Follows follows, double t_s) {
    double start_s = 0.0;
    for (const DesignedPiece& piece : pieces) {
        const double within_s = t_s - start_s;
        start_s += piece.duration_s;
        if (t_s > start_s - 1e-9) continue;
        if (piece.follows != follows) return not_in_force;
        if (piece.shape == Shape::constant) return piece.value;
        if (piece.shape == Shape::ramp)
            return piece.value + (piece.end - piece.value) * within_s / piece.duration_s;
        return piece.value +
               piece.amplitude * std::sin(2.0 * std::numbers::pi * piece.frequency_hz * within_s);
    }
    return not_in_force;
}

void expect_same(double expected, double value, double t_s) {
    if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(value)) << t_s;
    else
        EXPECT_NEAR(expected, value, 1e-9) << t_s;
}

void expect_commands(const Design& design, const Experiment& experiment) {
    EXPECT_EQ(design.carriage_mm, experiment.carriage_mm);
    EXPECT_NEAR(duration_s(design), experiment.duration_s, 1e-9);
    for (double t_s = 0.0; t_s < experiment.duration_s - 1e-9; t_s += 0.037) {
        expect_same(told(design.macro, Follows::voltage, t_s), value_at(experiment.macro_V, t_s), t_s);
        expect_same(told(design.macro, Follows::setpoint, t_s), value_at(experiment.macro_setpoint_mm, t_s),
                    t_s);
        expect_same(told(design.micro, Follows::voltage, t_s), value_at(experiment.micro_V, t_s), t_s);
        expect_same(told(design.micro, Follows::setpoint, t_s), value_at(experiment.micro_setpoint_mm, t_s),
                    t_s);
    }
}

TEST(Design, WrittenAndRead_IsTheSameExperiment) {
    constexpr std::uint64_t seed = 41;
    SCOPED_TRACE(seed);
    NoiseStream draw(seed, "designs");
    for (int k = 0; k < 40; ++k) {
        const Design design = drawn_design(reference_rig(), {}, draw);
        SCOPED_TRACE(experiment_yaml(design, "written"));
        expect_commands(design, experiment_of(design, "written", reference_rig()));
        EXPECT_EQ(rounded(design, reference_rig()), design);
    }
}

TEST(Design, OfAnyNumbers_KeepsTheLimits) {
    constexpr std::uint64_t seed = 42;
    SCOPED_TRACE(seed);
    const Rig& rig = reference_rig();
    NoiseStream draw(seed, "numbers");
    for (int k = 0; k < 200; ++k) {
        const Design form = drawn_design(rig, {}, draw);
        std::vector<double> shares = numbers(form, rig);
        for (double& share : shares) share = 1.4 * draw.uniform() - 0.2;
        const Design design = with_numbers(form, shares, rig);
        SCOPED_TRACE(experiment_yaml(design, "any"));
        const Experiment experiment = experiment_of(design, "any", rig);  // throws where record would refuse
        EXPECT_LE(experiment.duration_s, longest_s + 1e-9);
        EXPECT_GT(experiment.duration_s, 0.0);
    }
}

TEST(Design, ItsOwnNumbers_GiveItBack) {
    constexpr std::uint64_t seed = 43;
    SCOPED_TRACE(seed);
    NoiseStream draw(seed, "own numbers");
    for (int k = 0; k < 40; ++k) {
        const Design design = drawn_design(reference_rig(), {}, draw);
        EXPECT_EQ(with_numbers(design, numbers(design, reference_rig()), reference_rig()), design);
    }
}

TEST(Design, ExperimentOfTheList_IsCommandedAsItIs) {
    for (const std::string_view kind : {"macro-pulses", "macro-sweep", "macro-square", "micro-servo"}) {
        SCOPED_TRACE(kind);
        const Experiment listed = make_experiment(kind, reference_rig(), 1, "listed");
        const auto design = as_design(listed, reference_rig());
        ASSERT_TRUE(design.has_value());
        const Experiment experiment = experiment_of(*design, "listed", reference_rig());
        EXPECT_NEAR(experiment.duration_s, listed.duration_s, 1e-9);
        int apart = 0;  // ticks at a change that is not at a whole tick
        for (double t_s = 0.0; t_s < listed.duration_s - 1e-9; t_s += 1e-3) {
            for (const auto& [is, shall_be] :
                 {std::pair(value_at(experiment.macro_V, t_s), value_at(listed.macro_V, t_s)),
                  std::pair(value_at(experiment.macro_setpoint_mm, t_s),
                            value_at(listed.macro_setpoint_mm, t_s)),
                  std::pair(value_at(experiment.micro_setpoint_mm, t_s),
                            value_at(listed.micro_setpoint_mm, t_s))})
                if (!std::isnan(shall_be) && !(std::abs(is - shall_be) < 2e-3)) ++apart;
        }
        EXPECT_EQ(apart, 0);
    }
    EXPECT_FALSE(as_design(make_experiment("rest", reference_rig(), 1, "rest"), reference_rig()).has_value());
}

TEST(Design, RigWithoutMicroStageAndControllers_IsToldVoltages) {
    constexpr std::uint64_t seed = 44;
    SCOPED_TRACE(seed);
    Rig bare = reference_rig();
    bare.micro.reset();
    bare.macro.pd.reset();
    NoiseStream draw(seed, "bare");
    for (int k = 0; k < 50; ++k) {
        const Design design = drawn_design(bare, {}, draw);
        EXPECT_FALSE(design.macro.empty());
        EXPECT_TRUE(design.micro.empty());
        EXPECT_EQ(std::ranges::count(design.macro, Follows::setpoint, &DesignedPiece::follows), 0);
        EXPECT_NO_THROW((void)experiment_of(design, "bare", bare));
    }
}

}  // namespace
}  // namespace fidservo::design
