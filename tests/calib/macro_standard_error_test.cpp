// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the stated standard errors of identification agree with the scatter of its estimates.
#include "core/result.h"
#include "core/rig.h"
#include "tests/calib/macro_drive.h"
#include "tests/effort.h"

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

const int runs = testing::draws(60, 12);
constexpr double tick_s = 0.001, pole = 0.95833;

/// Mean square of (estimate - truth) / stated standard error over runs: 1 for right standard errors.
class Score {
  public:
    void add(const Result<MacroEstimate>& estimate, double truth) {
        ASSERT_TRUE(estimate) << estimate.error().text;
        squares_ += std::pow((estimate->value - truth) / estimate->std, 2) / runs;
    }
    /// 99.8 % of a chi-square law with as many degrees of freedom as runs, over that. Claims also count what
    /// a recording does not show (calib/macro/macro_knowledge.h), by which they may be larger than the
    /// scatter: half as large again here, of a motion without anything else.
    void expect_true(const std::string& name) const {
        ::testing::Test::RecordProperty(name, std::to_string(squares_));
        const double low = runs == 60 ? 0.53 : 0.185, high = runs == 60 ? 1.66 : 2.74;
        constexpr double most_counted = 1.5;
        EXPECT_GT(squares_, low / (most_counted * most_counted)) << name;
        EXPECT_LT(squares_, high) << name;
    }

  private:
    double squares_ = 0.0;
};

TEST(SlowMacroStandardErrors, RoundingAlone_ScattersAsClaimed) {
    const Rig rig = macro_rig();
    Score gain, tau, slope;
    NoiseStream draw(11, "standard errors");
    for (int i = 0; i < runs; ++i) {
        std::vector<double> volts;
        volts.reserve(6);
        for (int j = 0; j < 6; ++j) volts.push_back((j % 2 == 0 ? 1.0 : -1.0) * (3.2 + 1.6 * draw.uniform()));
        const MacroTrace trace = drive(rig, pulses(volts), 3.0, 100.0 + draw.uniform());
        const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
        ASSERT_TRUE(found) << found.error().text;
        gain.add(found->gain_mm_per_s_per_V, 198.84809);
        tau.add(found->time_constant_s, -tick_s / std::log(pole));
        slope.add(found->zone_slope, 0.636);
    }
    gain.expect_true("gain");
    tau.expect_true("time_constant");
    slope.expect_true("slope");
}

TEST(SlowMacroStandardErrors, NoiseOfManyCounts_ScattersAsClaimed) {
    const Rig rig = direct_rig();
    reference::Departures departures;
    departures.friction.coulomb_V = 0.5;
    departures.drive.offset_V = 0.1;
    const MacroTrace exact = drive(rig, pulses({2.0, -2.0, 4.0, -4.0, 1.5, -1.5}), 3.0, 100.0, departures);
    Score gain, tau, friction, offset;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(runs); ++seed) {
        MacroTrace trace = exact;
        NoiseStream noise(seed, "encoder");
        for (double& y_mm : trace.position_mm) y_mm += 0.01 * noise.normal();
        const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
        ASSERT_TRUE(found) << found.error().text;
        gain.add(found->gain_mm_per_s_per_V, 40.0);
        tau.add(found->time_constant_s, -tick_s / std::log(pole));
        friction.add(found->friction_V, 0.5);
        offset.add(found->drive_offset_V, 0.1);
    }
    gain.expect_true("gain");
    tau.expect_true("time_constant");
    friction.expect_true("friction");
    offset.expect_true("offset");
}

}  // namespace
}  // namespace fidservo::calib
