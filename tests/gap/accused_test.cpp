// SPDX-License-Identifier: GPL-3.0-or-later
// How evidence against blocks adds up, and when names are credible.
#include "gap/accused.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

std::vector<std::string> blocks(const std::vector<BlockProbability>& where) {
    std::vector<std::string> names;
    names.reserve(where.size());
    for (const BlockProbability& accused : where) names.push_back(accused.block);
    return names;
}

std::vector<FoundEffect> effects_of_probabilities(std::initializer_list<double> probabilities) {
    std::vector<FoundEffect> effects(probabilities.size());
    auto effect = effects.begin();
    for (const double probability : probabilities) (effect++)->probability = probability;
    return effects;
}

TEST(Accused, EvidenceAgainstABlock_AddsUpLikeIndependentCauses) {
    std::vector<BlockProbability> where;
    accuse(where, "macro.drive", 0.5);
    accuse(where, "macro.drive", 0.6);
    ASSERT_EQ(where.size(), 1U);
    EXPECT_DOUBLE_EQ(where.front().probability, 1.0 - 0.5 * 0.4);
}

TEST(Accused, BlocksAreInTheOrderOfTheirProbabilities) {
    std::vector<BlockProbability> where;
    accuse(where, "macro.drive", 0.2);
    accuse(where, "micro.hall", 0.9);
    accuse(where, "camera.timing", 0.5);
    EXPECT_EQ(blocks(where), (std::vector<std::string>{"micro.hall", "camera.timing", "macro.drive"}));
}

TEST(Accused, BlocksThatAreAboutAsLikely_StayInTheOrderInWhichTheyWereAccused) {
    std::vector<BlockProbability> where;
    accuse(where, "macro.drive", 0.50);
    accuse(where, "micro.hall", 0.51);
    EXPECT_EQ(blocks(where), (std::vector<std::string>{"macro.drive", "micro.hall"}));
}

TEST(Accused, NamesAreCredible_WhereTheyAreProbableOnAverage) {
    EXPECT_DOUBLE_EQ(mean_probability({}), 0.0);
    EXPECT_FALSE(are_credible({}));
    EXPECT_DOUBLE_EQ(mean_probability(effects_of_probabilities({0.2, 0.9})), 0.55);
    EXPECT_TRUE(are_credible(effects_of_probabilities({0.2, 0.9})));
    EXPECT_FALSE(are_credible(effects_of_probabilities({0.1, 0.9})));
}

}  // namespace
}  // namespace fidservo
