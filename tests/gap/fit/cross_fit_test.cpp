// SPDX-License-Identifier: GPL-3.0-or-later
// Fits to one half of the windows, judged on the other.
#include "gap/fit/cross_fit.h"

#include "gap/evidence/halves.h"
#include "gap/fit/score.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

CrossFitter fitter_of(const Evidence& evidence) {
    return {evidence, 48, [] { return false; }};
}

TEST(CrossFit, HalvesAreDisjointAndWhole) {
    const Evidence evidence = campaign({}, {"macro-pulses", "micro-steps"});
    const CrossFitter fitter = fitter_of(evidence);
    const Wanted one = fitter.half(0), other = fitter.half(1);
    for (std::size_t w = 0; w < one.size(); ++w) EXPECT_EQ(one[w] + other[w], 1);
}

TEST(CrossFit, EveryWindowIsJudgedByTheFitWithoutIt) {
    const Evidence evidence = campaign({}, {"macro-pulses"});
    const CrossFitter fitter = fitter_of(evidence);
    const Hypothesis slow = effects({"drive_gain:factor=0.95"});
    CrossFit cross{.of_half = {Hypothesis{}, slow}, .mean_squares = {}};
    fitter.judge(cross);
    const std::vector<double> by_none =
                                  mean_squares(evidence.windows(), evidence.errors({}, everything(evidence))),
                              by_slow = mean_squares(evidence.windows(),
                                                     evidence.errors(slow, everything(evidence)));
    const Wanted first_half = fitter.half(0);
    for (std::size_t w = 0; w < first_half.size(); ++w) {
        const double expected = first_half[w] ? by_slow[w] : by_none[w];
        if (std::isnan(expected)) continue;
        EXPECT_NEAR(cross.mean_squares[w], expected, 1e-6 * (1.0 + expected));
    }
    EXPECT_NEAR(cross.loss, total_loss(cross.mean_squares), 1e-9 * cross.loss);
}

TEST(CrossFit, OfTheTruth_HasNoExcess_OfNothingTheSignalsThatAreOff) {
    const Hypothesis truth = effects({"drive_gain:factor=1.05"});
    const Evidence evidence = campaign(truth, {"macro-pulses", "micro-steps"});
    const CrossFitter fitter = fitter_of(evidence);
    CrossFit right{.of_half = {truth, truth}, .mean_squares = {}}, nothing;
    fitter.judge(right);
    fitter.judge(nothing);
    EXPECT_EQ(fitter.excess(right.mean_squares), SignalExcess{});
    const SignalExcess off = fitter.excess(nothing.mean_squares);
    EXPECT_GT(off[index_of(Signal::encoder)], 1.0);
    EXPECT_DOUBLE_EQ(off[index_of(Signal::hall)], 0.0);
    EXPECT_GT(fitter.compared(nothing, right).gain, 1.0);
    EXPECT_DOUBLE_EQ(fitter.compared(right, right).gain, 0.0);
}

TEST(CrossFit, FittedAgain_BothHalvesComeToTheTruth) {
    const Evidence evidence = campaign(effects({"drive_gain:factor=1.05"}), {"macro-pulses"});
    const CrossFitter fitter = fitter_of(evidence);
    const Hypothesis start = effects({"drive_gain:factor=1.03"});
    CrossFit cross{.of_half = {start, start}, .mean_squares = {}};
    fitter.judge(cross);
    fitter.fit_again(cross, only(Signal::encoder));
    for (const Hypothesis& half : cross.of_half) EXPECT_NEAR(half.front().values.front(), 1.05, 1e-3);
}

TEST(CrossFit, JudgedBesideABase_IsAsJudgedAlone) {
    const Evidence evidence = campaign({}, {"macro-pulses", "micro-steps"});
    const CrossFitter fitter = fitter_of(evidence);
    CrossFit base;
    fitter.judge(base);
    const Hypothesis further = effects({"heater_gain:factor=1.02"});
    CrossFit beside{.of_half = {further, further}, .mean_squares = {}}, alone = beside;
    fitter.judge_beside(base, further, beside);
    fitter.judge(alone);
    for (std::size_t w = 0; w < alone.mean_squares.size(); ++w) {
        const double expected = alone.mean_squares[w];
        if (std::isnan(expected)) continue;
        EXPECT_NEAR(beside.mean_squares[w], expected, 1e-6 * (1.0 + expected));
    }
}

}  // namespace
}  // namespace fidservo
