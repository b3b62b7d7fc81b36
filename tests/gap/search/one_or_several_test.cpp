// SPDX-License-Identifier: GPL-3.0-or-later
// The list of single effects that were tried.
#include "gap/search/one_or_several.h"

#include "gap/candidates/candidate.h"
#include "tests/gap/simulated_campaign.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

TEST(TriedEffects, OfTwoTrialsOfACandidate_TheBetterOneStays_AndTheBestIsFirst) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses"});
    const std::vector<std::string> only{"payload", "drive_gain", "backlash"};
    const std::vector<Candidate> some = candidates(evidence, only, {});
    ASSERT_EQ(some.size(), 3U);
    const auto trial = [&](std::size_t k, double gain) { return Trial{.candidate = &some[k], .gain = gain}; };
    std::vector<Trial> alone{trial(0, 5.0), trial(1, 2.0)};
    add_tried(alone, {trial(0, 3.0), trial(1, 7.0), trial(2, 4.0)});
    ASSERT_EQ(alone.size(), 3U);
    EXPECT_EQ(alone[0].candidate, &some[1]);
    EXPECT_DOUBLE_EQ(alone[0].gain, 7.0);
    EXPECT_EQ(alone[1].candidate, &some[0]);
    EXPECT_DOUBLE_EQ(alone[1].gain, 5.0);
    EXPECT_EQ(alone[2].candidate, &some[2]);
}

}  // namespace
}  // namespace fidservo
