// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_refinement.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision/rendered_tag.h"
#include "vision/tags/tag_detector.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using testing::corners_of;
using testing::render;
using testing::RenderedTag;
using testing::Rendering;

Eigen::Vector2d mean(const std::array<Eigen::Vector2d, 4>& corners) {
    return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

/// Errors of the centre in px over one pixel's phases, and their squares in claimed standard deviations.
struct Errors {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Vector2d squares = Eigen::Vector2d::Zero();
    Eigen::Vector2d normalised = Eigen::Vector2d::Zero();
    Eigen::Vector2d worst_corner = Eigen::Vector2d::Zero();
    int count = 0;

    Eigen::Vector2d bias() const { return sum / count; }
    Eigen::Vector2d rms() const { return (squares / count).cwiseSqrt(); }
    Eigen::Vector2d claimed() const { return (normalised / count).cwiseSqrt(); }
};

Errors measure(const std::vector<RenderedTag>& tags, Rendering how) {
    TagDetector detector;
    Errors errors;
    for (const RenderedTag& tag : tags) {
        ++how.seed;
        const cv::Mat image = render({tag}, how);
        const std::vector<TagDetection> found = detector.detect(image, 0);
        EXPECT_EQ(found.size(), 1U);
        if (found.size() != 1) continue;
        const Result<RefinedTag> refined = refine_tag(image, found[0]);
        EXPECT_TRUE(refined) << refined.error().text;
        if (!refined) continue;
        const auto truth = corners_of(tag);
        const Eigen::Vector2d error = mean(refined->detection.corners_px) - mean(truth);
        const Eigen::Vector2d variance = refined->centre_covariance_px2.diagonal();
        errors.sum += error;
        errors.squares += error.cwiseAbs2();
        errors.normalised += error.cwiseAbs2().cwiseQuotient(variance);
        for (std::size_t k = 0; k < 4; ++k)
            errors.worst_corner =
                errors.worst_corner.cwiseMax((refined->detection.corners_px[k] - truth[k]).cwiseAbs());
        ++errors.count;
    }
    return errors;
}

std::vector<RenderedTag> over_all_phases(int count, double side_px, double angle_rad, std::uint64_t seed) {
    NoiseStream random(seed, "phases");
    std::vector<RenderedTag> tags;
    for (int k = 0; k < count; ++k)
        tags.push_back({k % 587, {319.0 + random.uniform(), 239.0 + random.uniform()}, side_px, angle_rad});
    return tags;
}

TEST(TagRefinement, UprightTagWithoutNoise_IsLimitedByTheGreyLevelsAlone) {
    // Every cross section of an upright edge is rounded to the same levels: up to half a level on a slope of
    // 90 levels a pixel.
    Rendering still;
    still.noise = false;
    const Errors errors = measure(over_all_phases(40, 300.0, 0.0, 1), still);
    EXPECT_LT(errors.rms().maxCoeff(), 0.5 / 90);
    EXPECT_LT(errors.bias().cwiseAbs().maxCoeff(), 0.001);
}

TEST(TagRefinement, UprightTagWithCameraNoise_IsPreciseUnbiasedAndSaysHowPrecise) {
    const Errors errors = measure(over_all_phases(60, 300.0, 0.0, 2), {});
    RecordProperty("centre_rms_px", std::to_string(errors.rms().maxCoeff()));
    EXPECT_LT(errors.rms().maxCoeff(), 0.0012);  // measured: 0.0008
    EXPECT_LT(errors.bias().cwiseAbs().maxCoeff(), 0.0004);
    EXPECT_LT(errors.worst_corner.maxCoeff(), 0.02);
    // 60 draws: the r.m.s. of errors in claimed standard deviations is 1 +- 0.09.
    EXPECT_GT(errors.claimed().minCoeff(), 0.7);
    EXPECT_LT(errors.claimed().maxCoeff(), 1.3);
}

TEST(TagRefinement, ShiftOfAHundredthOfAPixel_ComesBack) {
    TagDetector detector;
    double shift_px = 0.0;
    constexpr int pairs = 16;
    for (int k = 0; k < pairs; ++k)
        for (const int side : {0, 1}) {
            Rendering how;
            how.seed = 2 * k + side;
            const cv::Mat image = render({{7, {320.0 + k / 16.0 + 0.01 * side, 240.0}}}, how);
            const double u =
                mean(refine_tag(image, detector.detect(image, 0).at(0))->detection.corners_px).x();
            shift_px += (side == 1 ? u : -u) / pairs;
        }
    EXPECT_NEAR(shift_px, 0.01, 0.0015);  // 3 standard deviations of a mean of 16 differences of 0.0014 px
}

TEST(TagRefinement, TurnedTag_IsAsGood) {
    for (const double angle : {0.01, 0.4, 0.785, 2.5}) {
        const Errors errors = measure(over_all_phases(3, 200.0, angle, 3), {});
        EXPECT_LT(errors.rms().maxCoeff(), 0.004) << angle;
        EXPECT_LT(errors.worst_corner.maxCoeff(), 0.02) << angle;
    }
}

TEST(TagRefinement, TagFarOutOfFocus_IsMeasuredFromAnyFirstGuessOfItsBlur) {
    Rendering out_of_focus;
    out_of_focus.blur_px = 3.0;
    TagDetector detector;
    for (const RenderedTag& tag : over_all_phases(20, 290.0, 0.0, 6)) {
        ++out_of_focus.seed;
        const cv::Mat image = render({tag}, out_of_focus);
        const std::vector<TagDetection> found = detector.detect(image, 0);
        ASSERT_EQ(found.size(), 1U);
        for (const double guess_px : {1.0, 1.5, 2.0, 3.0, 4.0}) {
            RefinementOptions options;
            options.blur_px = guess_px;
            const Result<RefinedTag> refined = refine_tag(image, found[0], options);
            ASSERT_TRUE(refined) << "tag " << tag.id << ", blur " << guess_px
                                 << " px: " << refined.error().text;
            EXPECT_NEAR(refined->blur_px, 3.0, 0.05);
            EXPECT_LT((mean(refined->detection.corners_px) - mean(corners_of(tag))).norm(), 0.02);
        }
    }
}

TEST(TagRefinement, SmallTag_IsStillMeasured) {
    Rendering how;
    how.blur_px = 0.5;
    const Errors errors = measure(over_all_phases(20, 32.0, 0.0, 4), how);
    EXPECT_LT(errors.rms().maxCoeff(), 0.03);
}

/// A tag of which a rectangle is covered by an even grey.
struct Covered {
    RenderedTag tag{3, {320.4, 240.7}};
    Result<RefinedTag> refined;

    Covered(const cv::Rect& by, int grey) : refined(failure(Reason::no_tag, "")) {
        cv::Mat image = render({tag}, {});
        TagDetector detector;
        const TagDetection whole = detector.detect(image, 0).at(0);
        cv::rectangle(image, by, grey, cv::FILLED);
        refined = refine_tag(image, whole);
    }
    double error_px() const { return (refined->centre_px - tag.centre_px).norm(); }
};

TEST(TagRefinement, CoveredPartOfAnEdge_IsLeftOutAndReported) {
    const Covered covered({160, 150, 25, 40}, 229);  // white over the left border
    ASSERT_TRUE(covered.refined);
    EXPECT_LT(covered.refined->explained, 0.99);
    EXPECT_GT(covered.refined->explained, 0.9);
    EXPECT_LT(covered.error_px(), 0.002);
}

TEST(TagRefinement, CoveredBorder_LeavesTheCodeToMeasureBy) {
    const Covered covered({160, 80, 30, 320}, 120);
    ASSERT_TRUE(covered.refined);
    EXPECT_LT(covered.refined->explained, 0.92);
    EXPECT_LT(covered.error_px(), 0.003);
}

TEST(TagRefinement, TagCoveredButForASliver_IsOccluded) {
    const Covered covered({160, 80, 260, 320}, 120);
    ASSERT_FALSE(covered.refined);
    EXPECT_EQ(covered.refined.error().reason, Reason::occluded);
}

/// A camera that looks straight down does not show a square as a trapezoid.
TEST(TagRefinement, CameraThatCannotShowThisPicture_IsNotSaidToBeKnown) {
    const RenderedTag tag{3};
    cv::Mat image = render({tag}, {.noise = false});
    constexpr double shorter = 0.08;
    cv::Mat squeeze = cv::Mat::eye(3, 3, CV_64F);
    squeeze.at<double>(2, 1) = -shorter / tag.side_px;
    squeeze.at<double>(0, 1) = squeeze.at<double>(2, 1) * tag.centre_px.x();
    squeeze.at<double>(2, 2) = 1.0 + shorter * tag.centre_px.y() / tag.side_px;
    cv::Mat bent;
    cv::warpPerspective(image, bent, squeeze, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    RefinementOptions options;
    options.camera = CameraGeometry{640, 480, 3200.0, {319.5, 239.5}, 100.0};

    for (const auto& [picture, known] : {std::pair{image, true}, std::pair{bent, false}}) {
        TagDetector detector;
        const std::vector<TagDetection> found = detector.detect(picture, 0);
        ASSERT_EQ(found.size(), 1U);
        const Result<RefinedTag> refined = refine_tag(picture, found[0], options);
        ASSERT_TRUE(refined) << refined.error().text;
        EXPECT_EQ(refined->camera_known, known);
    }
}

TEST(TagRefinement, TagAcrossTheImageBorder_IsOccluded) {
    const RenderedTag tag{3, {148.0, 240.0}};
    const cv::Mat image = render({tag}, {});
    TagDetection claimed;
    claimed.tag_id = tag.id;
    claimed.corners_px = corners_of(tag);
    const Result<RefinedTag> refined = refine_tag(image, claimed);
    ASSERT_FALSE(refined);
    EXPECT_EQ(refined.error().reason, Reason::occluded);
}

}  // namespace
}  // namespace fidservo::vision
