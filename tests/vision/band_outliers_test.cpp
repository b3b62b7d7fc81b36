// SPDX-License-Identifier: GPL-3.0-or-later
// Which blocks are left out, on residuals made by hand.
#include "vision/tags/band_outliers.h"

#include "vision/tags/tag_pattern.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

using kernel::Near;

/// An upright tag of 320 px whose pixels all fit as noise lets them.
class JudgeBlocks : public ::testing::Test {
  protected:
    JudgeBlocks() {
        const TagPattern& pattern = tag_pattern({}, 20);
        const std::array<Eigen::Vector2d, 4> corners{
            Eigen::Vector2d{39.5, 359.5}, {359.5, 359.5}, {359.5, 39.5}, {39.5, 39.5}};
        const cv::Mat1b image(400, 400, static_cast<unsigned char>(0));
        select_band(image, {corners, pattern.cells, {}}, pattern, {3.0, 3.0}, 1.0, band_);
        for (const kernel::Block& block : band_.blocks)
            residuals_.push_back({0.0F, static_cast<float>(block.pixels)});
    }

    /// The outline's crossing in the middle of the upper side: an edge to the left, one to the right.
    std::size_t outline_crossing(float x) const {
        for (std::size_t n = 0; n < band_.nodes.size(); ++n)
            if (band_.nodes[n].x == x && band_.nodes[n].y == -4.0F) return n;
        ADD_FAILURE() << "no crossing at " << x;
        return 0;
    }

    std::vector<std::size_t> blocks_of(std::size_t node, Near near, float far_level) const {
        std::vector<std::size_t> blocks;
        for (std::size_t k = band_.nodes[node].first_block; k < band_.nodes[node].last_block; ++k)
            if (band_.blocks[k].near == near && band_.blocks[k].far_level == far_level) blocks.push_back(k);
        EXPECT_FALSE(blocks.empty());
        return blocks;
    }
    std::vector<std::size_t> middle_of(std::size_t node) const { return blocks_of(node, Near::both, 0.0F); }
    std::vector<std::size_t> left_of(std::size_t node) const { return blocks_of(node, Near::line_y, 0.0F); }
    std::vector<std::size_t> right_of(std::size_t node) const { return blocks_of(node, Near::line_y, 1.0F); }

    void spoil(std::size_t block) { residuals_[block].square_sum *= 5.0F; }

    /// So many standard deviations of the sum, spread over the blocks.
    void lean(const std::vector<std::size_t>& blocks, float deviations) {
        float pixels = 0.0F;
        for (const std::size_t k : blocks) pixels += static_cast<float>(band_.blocks[k].pixels);
        for (const std::size_t k : blocks)
            residuals_[k].sum = deviations * static_cast<float>(band_.blocks[k].pixels) / std::sqrt(pixels);
    }

    std::vector<std::size_t> left_out() const {
        BlockJudgement judgement;
        judge_blocks(band_, 1.0F, residuals_, judgement);
        follow_damage(band_, residuals_, judgement);
        const std::vector<float>& excess = judgement.excess;
        std::vector<std::size_t> out;
        for (std::size_t k = 0; k < excess.size(); ++k)
            if (excess[k] > 1.0F) out.push_back(k);
        return out;
    }

    EdgeBand band_;
    std::vector<kernel::Residuals> residuals_;
};

std::vector<std::size_t> all_of(const std::vector<std::vector<std::size_t>>& lists) {
    std::vector<std::size_t> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

using ::testing::UnorderedElementsAreArray;

TEST_F(JudgeBlocks, NothingSpoiled_NothingLeftOut) {
    EXPECT_TRUE(left_out().empty());
}

TEST_F(JudgeBlocks, OneBlockOfAnEdgeMisfits_TheEdgeAndItsCrossingGo) {
    const std::size_t node = outline_crossing(0.0F);
    spoil(left_of(node).front());
    EXPECT_THAT(left_out(), UnorderedElementsAreArray(all_of({left_of(node), middle_of(node)})));
}

TEST_F(JudgeBlocks, OneBlockWhereLinesMeetMisfits_GoesAlone) {
    const std::size_t block = middle_of(outline_crossing(0.0F)).front();
    spoil(block);
    EXPECT_THAT(left_out(), ::testing::ElementsAre(block));
}

TEST_F(JudgeBlocks, EdgeLeansBesideDamage_GoesWithItsCrossing) {
    const std::size_t node = outline_crossing(0.0F), beside = outline_crossing(1.0F);
    spoil(right_of(node).front());
    lean(left_of(beside), -4.0F);
    EXPECT_THAT(left_out(), UnorderedElementsAreArray(all_of(
                                {right_of(node), middle_of(node), left_of(beside), middle_of(beside)})));
}

TEST_F(JudgeBlocks, EdgeLeansFarFromDamage_Stays) {
    const std::size_t node = outline_crossing(0.0F);
    spoil(right_of(node).front());
    lean(left_of(outline_crossing(2.0F)), -4.0F);
    EXPECT_THAT(left_out(), UnorderedElementsAreArray(all_of({right_of(node), middle_of(node)})));
}

TEST_F(JudgeBlocks, CrossingLeansBesideDamage_GoesAsAWhole) {
    const std::size_t node = outline_crossing(0.0F), beside = outline_crossing(1.0F);
    spoil(right_of(node).front());
    const auto whole = all_of({left_of(beside), middle_of(beside), right_of(beside)});
    lean(whole, 4.0F);
    EXPECT_THAT(left_out(), UnorderedElementsAreArray(all_of({right_of(node), middle_of(node), whole})));
}

}  // namespace
}  // namespace fidservo::vision
