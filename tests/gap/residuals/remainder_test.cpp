// SPDX-License-Identifier: GPL-3.0-or-later
// What is left in several signals at once.
#include "gap/residuals/remainder.h"

#include "gap/fit/score.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;

constexpr double tail = 0.01;

/// What is left where nothing is named.
CrossFit nothing(const Evidence& evidence) {
    CrossFit cross;
    cross.mean_squares = mean_squares(evidence.windows(), evidence.errors({}, everything(evidence)));
    return cross;
}

TEST(Remainder, EverySignalThatIsOff_IsAskedOnWhatItsErrorsDepend) {
    const Evidence evidence =
        testing::campaign(effects({"viscous_friction:damping_V_s_per_mm=0.001", "heater_gain:factor=1.05"}),
                          {"macro-pulses", "micro-steps"});
    const CrossFit explained = nothing(evidence);
    const LeftOver left(evidence, explained);
    const std::vector<Remainder> all = left.remainders(tail);
    const auto of = [&](Signal signal) { return std::ranges::find(all, signal, &Remainder::signal); };
    ASSERT_NE(of(Signal::encoder), all.end());
    ASSERT_NE(of(Signal::hall), all.end());
    EXPECT_EQ(of(Signal::encoder)->block, "macro.friction");
    EXPECT_FALSE(of(Signal::hall)->depends_on.empty());
    EXPECT_TRUE(of(Signal::hall)->block.starts_with("micro.")) << of(Signal::hall)->block;

    const auto first = left.first_remainder(tail);
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(first->text, all.front().text);
}

TEST(Remainder, SignalWhoseDiscrepancyDoesNotMatter_IsIgnored) {
    const Evidence evidence =
        testing::campaign(effects({"viscous_friction:damping_V_s_per_mm=0.001", "heater_gain:factor=1.05"}),
                          {"macro-pulses", "micro-steps"});
    const CrossFit explained = nothing(evidence);
    SignalLimits matters{};
    matters[index_of(Signal::encoder)] = 1e9;
    for (const Remainder& remainder : LeftOver(evidence, explained).remainders(tail, matters))
        EXPECT_NE(remainder.signal, Signal::encoder) << remainder.text;
}

TEST(Remainder, RigAsItsFileSays_LeavesNone) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses", "micro-steps"});
    const CrossFit explained = nothing(evidence);
    EXPECT_TRUE(LeftOver(evidence, explained).remainders(tail).empty());
    EXPECT_EQ(LeftOver(evidence, explained).signals(), SignalFlags{});
}

}  // namespace
}  // namespace fidservo
