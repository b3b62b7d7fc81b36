// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/fod_curves.h"

#include "core/failure.h"
#include "core/result.h"
#include "tests/calib/relay_wire.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double encoder_mm = 0.014;  // of the published oven

TEST(FodCurves, KilnCycles_GiveCurvesTableAndPredictionOfOtherProfiles) {
    constexpr std::uint64_t wire = 1;
    const HysteresisTrace other = record_wire(ramps(25.0, random_turns(9, 60), 0.1), wire, 0.0, 0.0);
    for (const double noise_degC : {0.0, 0.2}) {
        SCOPED_TRACE(::testing::Message() << "noise " << noise_degC << " degC");
        const auto fod =
            identify_fod(record_wire(ramps(25.0, kiln_turns(), 0.1), wire, noise_degC, encoder_mm));
        ASSERT_TRUE(fod) << fod.error().text;
        EXPECT_EQ(fod->descending.size(), 11U);
        EXPECT_EQ(fod->cycles_left_out, 0U);
        EXPECT_NEAR(fod->descending.front().peak, 110.0, 3.0 * noise_degC + 1e-9);
        EXPECT_NEAR(fod->descending.back().peak, 60.0, 3.0 * noise_degC + 1e-9);
        EXPECT_LT(fod->readings_rms, 0.014);
        EXPECT_LT(prediction_rms(fod->fit, other), noise_degC > 0.0 ? 0.015 : 0.009);
    }
}

TEST(FodCurves, Table_RisesWithBothTemperatures) {
    const auto fod = identify_fod(record_wire(ramps(25.0, kiln_turns(), 0.1), 3, 0.2, encoder_mm));
    ASSERT_TRUE(fod) << fod.error().text;
    const FodTable& table = fod->fit.table;
    for (std::size_t i = 0; i < table.nodes(); ++i) {
        EXPECT_EQ(table.node_mm(i, 0), 0.0);
        for (std::size_t j = 0; j <= i; ++j) {
            if (j > 0) {
                EXPECT_GE(table.node_mm(i, j), table.node_mm(i, j - 1));
            }
            if (i > j) {
                EXPECT_GE(table.node_mm(i, j), table.node_mm(i - 1, j));
            }
        }
    }
}

TEST(FodCurves, Readings_LieWithinTheirStandardErrorsOfTheWire) {
    const auto fod = identify_fod(record_wire(ramps(25.0, kiln_turns(), 0.1), 3, 0.0, encoder_mm));
    ASSERT_TRUE(fod) << fod.error().text;
    double squares = 0.0, count = 0.0;
    for (const FodCurve& curve : fod->descending)
        for (const FodReading& reading : curve.readings) {
            RelayWire wire(3);
            wire.move(curve.peak);
            squares += std::pow((wire.move(reading.temp) - reading.output) / reading.std, 2);
            count += 1.0;
        }
    EXPECT_GT(count, 150.0);
    // 1 would be perfect; but the encoder's rounding is not Gaussian, and the curve is not straight within a
    // cell.
    EXPECT_LT(std::sqrt(squares / count), 1.6);
}

TEST(FodCurves, CyclesThatDoNotReturnToTheCold_AreNotFirstOrder) {
    const auto fod = identify_fod(record_wire(
        ramps(25.0, {110.0, 25.0, 100.0, 50.0, 90.0, 25.0, 80.0, 25.0}, 0.1), 1, 0.0, encoder_mm));
    ASSERT_TRUE(fod) << fod.error().text;
    EXPECT_EQ(fod->cycles_left_out, 1U);
    EXPECT_EQ(fod->descending.size(), 3U);
}

TEST(FodCurves, OneCycle_IsRefused) {
    const auto fod = identify_fod(record_wire(ramps(25.0, {110.0, 25.0}, 0.1), 1, 0.0, encoder_mm));
    ASSERT_FALSE(fod);
    EXPECT_EQ(fod.error().reason, Reason::not_identifiable);
    EXPECT_FALSE(identify_fod({}));
}

}  // namespace
}  // namespace fidservo::calib
