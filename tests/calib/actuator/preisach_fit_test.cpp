// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_fit.h"

#include "calib/wire/preisach_shift.h"
#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/calib/relay_wire.h"
#include "tests/shared_table.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

using testing::column;
using testing::shared_table;

constexpr double encoder_mm = 0.014;

/// R.m.s. in mm over the nodes of standard error's validity: error of a node over its standard error.
struct NodeErrors {
    double rms_mm = 0.0, rms_in_std = 0.0;
    std::size_t determined = 0;
};

NodeErrors node_errors(const PreisachFit& fit, std::uint64_t wire_seed) {
    NodeErrors errors;
    const FodTable& table = fit.table;
    for (std::size_t i = 1; i < table.nodes(); ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            const std::size_t node = cell_index(i, j);
            if (!fit.determined[node] || fit.node_std[node] <= 0.0) continue;
            RelayWire wire(wire_seed);
            wire.move(table.low_degC() + table.step_degC() * static_cast<double>(i));
            const double truth = wire.move(table.low_degC() + table.step_degC() * static_cast<double>(j));
            const double error = fit.offset + table.node_mm(i, j) - truth;
            errors.rms_mm += error * error;
            errors.rms_in_std += error * error / (fit.node_std[node] * fit.node_std[node]);
            ++errors.determined;
        }
    errors.rms_mm = std::sqrt(errors.rms_mm / static_cast<double>(errors.determined));
    errors.rms_in_std = std::sqrt(errors.rms_in_std / static_cast<double>(errors.determined));
    return errors;
}

TEST(PreisachFit, ModelThatLiesOnTheGrid_IsRecoveredExactly) {
    const PreisachGrid grid{20.0, 10.0, 8};
    NoiseStream draw(4, "weights");
    std::vector<double> weights(cell_count(grid));
    for (double& weight : weights) weight = draw.uniform() < 0.3 ? 0.0 : draw.uniform();
    const FodTable truth = table_of_density(grid, weights);
    std::vector<double> turns{90.0, 20.0};
    while (turns.size() < 150) turns.push_back(20.0 + 70.0 * draw.uniform());
    HysteresisTrace trace{ramps(20.0, turns, 1.3), {}};
    PreisachMemory memory = preisach_start(truth, 20.0);
    for (const double input : trace.input)
        trace.output.push_back(-3.0 - 2.0 * preisach_step(truth, memory, input));
    const auto fit = fit_preisach(trace, {.nodes = 8, .least_reversal = 0.0});
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_EQ(fit->direction, -1.0);
    EXPECT_NEAR(fit->offset, -3.0, 1e-3);
    for (std::size_t i = 0; i < grid.nodes; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            EXPECT_NEAR(fit->table.node_mm(i, j), 2.0 * truth.node_mm(i, j), 1e-3) << i << ", " << j;
}

TEST(SlowPreisachFit, WireOfRelays_IsPredictedOnProfilesItWasNotFittedTo) {
    constexpr std::uint64_t wire = 1;
    const HysteresisTrace other = record_wire(ramps(25.0, random_turns(9, 60), 0.1), wire, 0.0, 0.0);
    for (const double noise_degC : {0.0, 0.2}) {
        SCOPED_TRACE(::testing::Message() << "noise " << noise_degC << " degC");
        const auto fit = fit_preisach(
            record_wire(ramps(25.0, random_turns(3, 80), 0.1), wire, noise_degC, encoder_mm), {.nodes = 31});
        ASSERT_TRUE(fit) << fit.error().text;
        // Encoder steps alone leave 14 / sqrt(12) = 4 um; 0.2 degC on the loop's 0.2 mm/degC flanks more.
        EXPECT_LT(prediction_rms(*fit, other), noise_degC > 0.0 ? 0.015 : 0.009);
        const NodeErrors errors = node_errors(*fit, wire);
        EXPECT_GT(errors.determined, 400U);
        EXPECT_LT(errors.rms_mm, 0.015);
        EXPECT_LT(errors.rms_in_std, 2.5);
    }
}

TEST(PreisachFit, InverseThenWire_ReturnsTheContractionAskedFor) {
    constexpr std::uint64_t wire_seed = 1;
    const auto fit = fit_preisach(
        record_wire(ramps(25.0, random_turns(3, 80), 0.1), wire_seed, 0.0, encoder_mm), {.nodes = 31});
    ASSERT_TRUE(fit);
    NoiseStream draw(8, "targets");
    RelayWire wire(wire_seed);
    wire.move(25.0);
    PreisachMemory memory = preisach_start(fit->table, 25.0);
    double squares = 0.0;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i) {
        const double target_mm = 0.2 + 3.6 * draw.uniform();
        const auto temp_degC = preisach_inverse(fit->table, memory, target_mm - fit->offset);
        ASSERT_TRUE(temp_degC);
        preisach_step(fit->table, memory, *temp_degC);
        squares += std::pow(wire.move(*temp_degC) - target_mm, 2);
    }
    EXPECT_LT(std::sqrt(squares / n), 0.015);
}

TEST(PreisachFit, MajorLoopOnly_DeterminesItsBranchesAndFlagsTheInside) {
    const HysteresisTrace loops =
        record_wire(ramps(25.0, {110.0, 25.0, 110.0, 25.0, 110.0, 25.0}, 0.1), 2, 0.0, encoder_mm);
    const auto fit = fit_preisach(loops, {.nodes = 18});
    ASSERT_TRUE(fit) << fit.error().text;
    const std::size_t last = fit->table.nodes() - 1;
    for (std::size_t j = 0; j <= last; ++j) {
        EXPECT_TRUE(fit->determined[cell_index(last, j)]) << j;
        EXPECT_TRUE(fit->determined[cell_index(j, j)]) << j;
    }
    // Peak 76 degC, cooled to 56: half the relays switched on, a quarter off; a loop shows only sums of them.
    EXPECT_FALSE(fit->determined[cell_index(10, 6)]);
}

TEST(PreisachFit, TemperaturesNeverReached_AreFlagged) {
    const HysteresisTrace trace =
        record_wire(ramps(25.0, {76.0, 25.0, 70.0, 25.0, 65.0, 25.0}, 0.1), 2, 0.0, 0.0);
    const auto fit = fit_preisach(trace, {.nodes = 18, .high = 110.0});
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_FALSE(fit->determined[cell_index(17, 17)]);
    EXPECT_FALSE(fit->determined[cell_index(14, 3)]);
    EXPECT_TRUE(fit->determined[cell_index(9, 9)]);
}

TEST(PreisachFit, Piezo_IsFittedBetterThanThirteenPlaysAndHoldsOnTheOtherHalf) {
    const auto rows = shared_table("hysteresis/piezo_model.dat", 0);
    if (rows.empty()) GTEST_SKIP() << "the shared data are absent";
    const HysteresisTrace trace{column(rows, 0), column(rows, 4)};
    const auto all = fit_preisach(trace);
    ASSERT_TRUE(all) << all.error().text;
    EXPECT_LT(all->residual_rms, 0.21);  // um; 2.49 linear, 0.375 thirteen play operators
    const std::size_t half = trace.input.size() / 2;
    const auto first = fit_preisach(trace, {.last = half}), second = fit_preisach(trace, {.first = half});
    ASSERT_TRUE(first && second);
    EXPECT_LT(prediction_rms(*first, trace, half), 0.29);
    EXPECT_LT(prediction_rms(*second, trace, first_known_memory(trace.input), half), 0.32);
}

TEST(PreisachShift, LoopOfOneStress_MovedByOneShift_PredictsTheOther) {
    const auto rows100 = shared_table("sma/filtered_data_100MPa.txt", 1);
    const auto rows150 = shared_table("sma/filtered_data_150MPa.txt", 1);
    if (rows100.empty() || rows150.empty()) GTEST_SKIP() << "the shared data are absent";
    const auto model = fit_preisach({column(rows100, 0), column(rows100, 1)}, {.nodes = 40});
    ASSERT_TRUE(model) << model.error().text;
    const auto shift = fit_temperature_shift(*model, {column(rows150, 0), column(rows150, 1)});
    ASSERT_TRUE(shift) << shift.error().text;
    EXPECT_LT(model->residual_rms, 0.0003);  // strain, of 0.0435
    EXPECT_LT(shift->rms, 0.0008);
    EXPECT_GT(shift->rms_unshifted, 5.0 * shift->rms);
    EXPECT_NEAR(shift->shift / 50.0, 0.13, 0.02);  // degC per MPa: 6 to 8 MPa/degC is usual for NiTi
}

TEST(PreisachShift, KnownShift_IsReturned) {
    const std::vector<double> course = ramps(25.0, {110.0, 25.0, 85.0, 25.0}, 0.1);
    HysteresisTrace trace = record_wire(course, 5, 0.0, 0.0);
    const auto model = fit_preisach(trace, {.nodes = 31});
    ASSERT_TRUE(model);
    for (double& temp : trace.input) temp += 3.7;
    const auto shift = fit_temperature_shift(*model, trace);
    ASSERT_TRUE(shift) << shift.error().text;
    EXPECT_NEAR(shift->shift, 3.7, 3.0 * shift->shift_std + 0.01);
}

TEST(PreisachFit, UselessData_AreRefusedWithTheReason) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> ramp = ramps(0.0, {10.0, 0.0}, 0.1);
    const std::vector<double> flat(ramp.size(), 1.0);
    std::vector<double> holed = ramp, huge = ramp;
    holed[17] = nan;
    huge[17] = 1e300;
    for (const HysteresisTrace& trace :
         {HysteresisTrace{}, HysteresisTrace{{1.0, 2.0}, {1.0, 2.0}}, HysteresisTrace{ramp, flat},
          HysteresisTrace{flat, ramp}, HysteresisTrace{holed, ramp}, HysteresisTrace{ramp, huge},
          HysteresisTrace{ramp, {1.0}}}) {
        const auto fit = fit_preisach(trace);
        ASSERT_FALSE(fit);
        EXPECT_EQ(fit.error().reason, Reason::not_identifiable);
        EXPECT_FALSE(fit.error().text.empty());
    }
    EXPECT_FALSE(fit_preisach({ramp, ramp}, {.nodes = 2}));
    EXPECT_FALSE(fit_preisach({ramp, ramp}, {.low = 5.0, .high = 4.0}));
}

TEST(PreisachFit, RandomData_NeverBreakIt) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        NoiseStream draw(seed, "robustness");
        HysteresisTrace trace;
        const auto n = static_cast<std::size_t>(200.0 * draw.uniform());
        const double scale = std::pow(10.0, 40.0 * draw.uniform() - 20.0);
        const bool coarse = draw.uniform() < 0.5;
        for (std::size_t k = 0; k < n; ++k) {
            const double value = coarse ? std::floor(3.0 * draw.uniform()) : draw.normal();
            trace.input.push_back(value * scale);
            trace.output.push_back(draw.uniform() < 0.5 ? value : draw.normal() / scale);
        }
        const auto fit = fit_preisach(trace, {.nodes = 3 + seed % 7});
        if (!fit) continue;
        EXPECT_TRUE(std::isfinite(fit->residual_rms));
        for (const double value : predict(*fit, trace.input)) EXPECT_TRUE(std::isfinite(value));
    }
}

}  // namespace
}  // namespace fidservo::calib
