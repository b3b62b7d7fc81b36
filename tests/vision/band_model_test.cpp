// SPDX-License-Identifier: GPL-3.0-or-later
// Equations of a band whose blocks' weights change, against equations added up anew.
#include "vision/tags/band_model.h"

#include "vision/tags/tag_pattern.h"

#include <array>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

constexpr int tag_id = 20;

TEST(Reweigh, SomeBlocksChange_AsIfAllWereAddedUpAnew) {
    constexpr unsigned seed = 7;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    cv::Mat1b image(300, 300);
    for (unsigned char& grey : image) grey = static_cast<unsigned char>(random() % 256);
    const std::array<Eigen::Vector2d, 4> corners{
        Eigen::Vector2d{52.0, 251.0}, {248.0, 255.0}, {252.0, 49.0}, {50.0, 46.0}};
    const TagPattern& pattern = tag_pattern({}, tag_id);
    const TagPicture picture(corners, pattern.cells, {});
    BandLook look;
    look.black_grey = 30.0;
    look.white_grey = 200.0;
    const GreyNoise noise{0.025, 0.1, 0.0};
    EdgeBand band;
    select_band(image, picture, pattern, {3.0, 3.0}, 1.0, band);
    ASSERT_GT(band.blocks.size(), 100U);

    std::vector<kernel::Residuals> residuals;
    for (float& weight : band.weights) weight = random() % 2 == 0 ? 1.0F : 0.4F;
    BandEquations changed = evaluate_band(band, picture, look, noise, residuals);
    const std::vector<float> before = band.weights;
    for (float& weight : band.weights)
        if (random() % 3 == 0) weight = random() % 2 == 0 ? 0.0F : 0.7F;
    reweigh(changed, band, before, picture, look, noise);

    const BandEquations anew = evaluate_band(band, picture, look, noise, residuals);
    constexpr double rounding = 1e-5;
    EXPECT_LT((changed.normal - anew.normal).norm(), rounding * anew.normal.norm());
    EXPECT_LT((changed.right - anew.right).norm(), rounding * anew.right.norm());
    EXPECT_NEAR(changed.square_sum, anew.square_sum, rounding * anew.square_sum);
}

/// Every pixel within reach of an edge once, and no other: an upright tag of whole pixels a cell, counted by
/// hand.
TEST(SelectBand, UprightTag_HasEveryPixelWithinReachOnce) {
    constexpr double cell_px = 20.0, reach_px = 3.0;
    const TagPattern& pattern = tag_pattern({}, tag_id);
    const double first_px = 59.5, last_px = first_px + cell_px * pattern.cells;
    const std::array<Eigen::Vector2d, 4> corners{
        Eigen::Vector2d{first_px, last_px}, {last_px, last_px}, {last_px, first_px}, {first_px, first_px}};
    const cv::Mat1b image(300, 300, static_cast<unsigned char>(0));
    EdgeBand band;
    select_band(image, TagPicture(corners, pattern.cells, {}), pattern, {reach_px, reach_px}, 1.0, band);

    const auto white = [&](int column, int row) {
        const bool inside = column >= 0 && row >= 0 && column < pattern.cells && row < pattern.cells;
        return !inside || pattern[row * pattern.cells + column];
    };
    cv::Mat1b near_edge(image.size(), static_cast<unsigned char>(0));
    const auto mark = [&](double u, double v, double half_width, double half_height) {
        near_edge(cv::Rect(static_cast<int>(u - half_width + 0.5), static_cast<int>(v - half_height + 0.5),
                           static_cast<int>(2 * half_width), static_cast<int>(2 * half_height))) = 1;
    };
    for (int row = -1; row <= pattern.cells; ++row)
        for (int column = -1; column <= pattern.cells; ++column) {
            const double u = first_px + cell_px * column, v = first_px + cell_px * row;  // upper left corner
            if (white(column, row) != white(column - 1, row))
                mark(u, v + 0.5 * cell_px, reach_px, 0.5 * cell_px + reach_px);
            if (white(column, row) != white(column, row - 1))
                mark(u + 0.5 * cell_px, v, 0.5 * cell_px + reach_px, reach_px);
        }
    EXPECT_EQ(band.pixels, static_cast<std::size_t>(cv::countNonZero(near_edge)));
}

}  // namespace
}  // namespace fidservo::vision
