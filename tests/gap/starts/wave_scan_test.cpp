// SPDX-License-Identifier: GPL-3.0-or-later
// A weak periodic force that does not show in the balance of forces, only in the direction that the carriage
// takes.
#include "gap/starts/wave_scan.h"

#include "core/rig.h"
#include "gap/candidates/coupling.h"
#include "gap/fit/score.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;

std::optional<plant::EffectSetting> scanned(const Hypothesis& truth, const Hypothesis& known) {
    constexpr double far_off_square = 9.0;
    const Evidence evidence =
        testing::campaign(truth, {"macro-sweep", "macro-pulses", "macro-square", "integrated"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const auto cogging = std::ranges::find(all, std::string_view("cogging"),
                                           [](const Candidate& c) { return c.effect->name; });
    Wanted far_off = only_of(evidence.windows(), everything(evidence), only(Signal::encoder));
    const auto squares = mean_squares(evidence.windows(), evidence.errors(known, far_off));
    for (std::size_t w = 0; w < squares.size(); ++w)
        if (!(squares[w] > far_off_square)) far_off[w] = 0;
    const auto predictor = [&](const Wanted& wanted) {
        return [&evidence, wanted](const Hypothesis& whole) { return evidence.errors(whole, wanted); };
    };
    return scan_for_wave(predictor, evidence.windows(), far_off, known, *cogging, evidence.rig().macro);
}

/// Within half a step of the scan, and a sixth of a period in the middle of the rail.
void expect_is_wave(const std::optional<plant::EffectSetting>& found, double amplitude_V, double period_mm,
                    double phase_rad) {
    ASSERT_TRUE(found);
    EXPECT_NEAR(1.0 / found->values[1], 1.0 / period_mm, 0.0026);
    EXPECT_NEAR(std::log(found->values[0] / amplitude_V), 0.0, std::log(2.5));
    constexpr double middle_mm = 100.0;
    const auto in_the_middle = [&](double phase, double period) {
        return phase + 2.0 * std::numbers::pi * middle_mm / period;
    };
    EXPECT_NEAR(std::remainder(
                    in_the_middle(found->values[2], found->values[1]) - in_the_middle(phase_rad, period_mm),
                    2.0 * std::numbers::pi),
                0.0, std::numbers::pi / 3.0);
}

TEST(SlowWaveScan, WaveOfFewMillivolts_IsFound) {
    expect_is_wave(scanned(effects({"cogging:amplitude_V=0.006,period_mm=3.33,phase_rad=1.2"}), {}), 0.006,
                   3.33, 1.2);
}

TEST(SlowWaveScan, WithItsHarmonic_BesideAMassThatIsNotKnown_IsFound) {
    expect_is_wave(scanned(effects({"payload:mass_factor=1.2",
                                    "cogging:amplitude_V=0.012,period_mm=5.2,phase_rad=-2,second_sine=0.1"}),
                           {}),
                   0.012, 5.2, -2.0);
}

TEST(WaveScan, NothingFarOff_FindsNothing) {
    EXPECT_FALSE(scanned({}, {}));
}

}  // namespace

}  // namespace fidservo
