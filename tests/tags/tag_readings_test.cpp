// SPDX-License-Identifier: GPL-3.0-or-later
// Every family, with borders of one and two cells, inverted and mirrored: read as what it is, and measured.
#include "tests/effort.h"
#include "tests/tags/drawn_tag.h"
#include "tests/variations.h"
#include "vision/tags/tag_appearance.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

using fidservo::testing::between;
using fidservo::testing::draw;
using fidservo::testing::DrawnTag;
using fidservo::testing::one_of;
using fidservo::testing::random_corners;

/// Errors of refined corners, and how they compare to what is claimed.
struct CornerErrors {
    double squares_px2 = 0.0, squares_of_claimed = 0.0, worst_px = 0.0;
    int corners = 0, unrefined = 0;

    void add(const RefinedTag& tag, const std::array<Eigen::Vector2d, 4>& true_px) {
        for (int k = 0; k < 4; ++k) {
            const Eigen::Vector2d off =
                tag.detection.corners_px[static_cast<std::size_t>(k)] - true_px[static_cast<std::size_t>(k)];
            const Eigen::Matrix2d covariance = tag.covariance_px2.block<2, 2>(2 * k, 2 * k);
            squares_px2 += 0.5 * off.squaredNorm();
            squares_of_claimed += 0.5 * off.dot(covariance.inverse() * off);
            worst_px = std::max(worst_px, off.norm());
            ++corners;
        }
    }
    double rms_px() const { return std::sqrt(squares_px2 / corners); }
    double rms_of_claimed() const { return std::sqrt(squares_of_claimed / corners); }
};

double most_off_px(const std::array<Eigen::Vector2d, 4>& a, const std::array<Eigen::Vector2d, 4>& b) {
    double most = 0.0;
    for (std::size_t k = 0; k < 4; ++k) most = std::max(most, (a[k] - b[k]).norm());
    return most;
}

const RefinementOptions as_drawn{.camera = std::nullopt,
                                 .noise = {0.0, 1.0 + 1.0 / 12.0, 0.0},
                                 .motion_px = Eigen::Vector2d::Zero(),
                                 .blur_px = 1.0};

Outcome read_one(const TagReading& reading, std::mt19937_64& random, CornerErrors& errors) {
    const double side_px = between(6.0, 12.0, random) * fidservo::testing::size_of(reading.print).outline;
    const int size_px =
        static_cast<int>(3.6 * side_px * (reading.print.family->has_plain_border() ? 0.6 : 1.0));
    const Eigen::Vector2d centre_px(0.5 * size_px + between(-2.0, 2.0, random),
                                    0.5 * size_px + between(-2.0, 2.0, random));
    const DrawnTag tag{.reading = reading,
                       .id = one_of(reading.print.family->size(), random),
                       .corners_px = random_corners(centre_px, side_px, reading.mirrored, random),
                       .corner_squares = reading.print.border_cells == 2 && one_of(2, random) == 1};
    const cv::Mat image = draw({tag}, {size_px, size_px}, between(0.6, 1.0, random), random);
    const auto found = TagDetector(thorough_options(reading)).detect(image, 0);
    const std::string name =
        fmt::format("{}{}, id {}", reading.mirrored ? "mirrored " : "", text_of(reading.print), tag.id);
    if (found.empty()) return Outcome::refused(name + ": not found");
    if (found.size() > 1 || found.front().tag_id != tag.id)
        return Outcome::wrong(
            fmt::format("{}: {} tags found, the first {}", name, found.size(), found.front().tag_id));
    const auto refined = refine_tag(image, found.front(), as_drawn);
    if (!refined) {
        if (const double off = most_off_px(found.front().corners_px, tag.corners_px); off > 1.0)
            return Outcome::wrong(fmt::format("{}: corners found {:.2f} px off", name, off));
        ++errors.unrefined;
        return Outcome::refused(fmt::format("{}: {}", name, refined.error().text));
    }
    errors.add(*refined, tag.corners_px);
    const double off = most_off_px(refined->detection.corners_px, tag.corners_px);
    constexpr double most_px = 0.25;
    if (off > most_px) return Outcome::wrong(fmt::format("{}: corners measured {:.3f} px off", name, off));
    return Outcome::right();
}

void expect_read(const std::string& kind, const std::function<TagReading(std::mt19937_64&)>& draw_reading) {
    CornerErrors errors;
    expect_right_or_refused(kind, fidservo::testing::draws(200, 50), [&](std::mt19937_64& random) {
        const TagReading reading = draw_reading(random);
        return read_one(reading, random, errors);
    });
    fmt::print("{}: corners {:.4f} px rms, {:.2f} of claimed, worst {:.3f} px; {} not measured\n", kind,
               errors.rms_px(), errors.rms_of_claimed(), errors.worst_px, errors.unrefined);
    EXPECT_LT(errors.rms_of_claimed(), 1.5);
    EXPECT_LE(errors.unrefined, 4);
}

TagReading any_reading(std::mt19937_64& random) {
    TagReading reading{fidservo::testing::random_print(random)};
    if (reading.print.family->has_plain_border()) reading.print.border_cells = 1 + one_of(2, random);
    return reading;
}

TEST(TagReadings, UsualFamily_IsReadAndMeasured) {
    expect_read("usual tags", [](std::mt19937_64&) { return TagReading{}; });
}

TEST(TagReadings, AnyFamily_IsReadAndMeasured) {
    expect_read("families",
                [](std::mt19937_64& random) { return TagReading{fidservo::testing::random_print(random)}; });
}

TEST(TagReadings, BorderOfTwoCells_IsReadAndMeasured) {
    expect_read("borders", [](std::mt19937_64& random) {
        TagReading reading = any_reading(random);
        while (!reading.print.family->has_plain_border()) reading = any_reading(random);
        reading.print.border_cells = 2;
        return reading;
    });
}

TEST(TagReadings, Mirrored_IsReadAndMeasured) {
    expect_read("mirrored", [](std::mt19937_64& random) {
        TagReading reading = any_reading(random);
        reading.mirrored = true;
        return reading;
    });
}

TEST(TagReadings, Inverted_IsReadAndMeasured) {
    expect_read("inverted", [](std::mt19937_64& random) {
        TagReading reading = any_reading(random);
        reading.print.inverted = true;
        reading.mirrored = one_of(2, random) == 1;
        return reading;
    });
}

TEST(TagReadings, MirroredUnderAKnownCamera_IsMeasuredAsWithout) {
    std::mt19937_64 random(5);
    const TagReading reading{{}, true};
    const CameraGeometry camera{200, 200, 2000.0, {99.5, 99.5}, 20.0};
    const double c = std::cos(0.3), s = std::sin(0.3);
    DrawnTag tag{.reading = reading, .id = 77, .corners_px = {}};
    for (std::size_t k = 0; k < 4; ++k) {
        const double x = -48.0 * tag_corners[k].x(), y = 48.0 * tag_corners[k].y();
        tag.corners_px[k] = Eigen::Vector2d(101.0 + c * x - s * y, 98.0 + s * x + c * y);
    }
    const cv::Mat image = draw({tag}, {200, 200}, 0.8, random);
    const auto found = TagDetector(machine_camera_options(reading)).detect(image, 0);
    ASSERT_EQ(found.size(), 1U);
    RefinementOptions options = as_drawn;
    options.camera = camera;
    const auto refined = refine_tag(image, found.front(), options);
    ASSERT_TRUE(refined.has_value());
    EXPECT_TRUE(refined->camera_known);
    EXPECT_LT(most_off_px(refined->detection.corners_px, tag.corners_px), 0.05);
}

TEST(TagReadings, OutlineThatIsWhiteInside_HasItsBlurMeasured) {
    std::mt19937_64 random(6);
    double usual_px2 = 0.0;
    for (const TagReading& reading : {TagReading{}, TagReading{{&usual_tag_family(), 1, true}},
                                      TagReading{{find_tag_family("tagStandard41h12")}}}) {
        constexpr double side_px = 160.0, blur_px = 1.5;
        DrawnTag tag{.reading = reading, .id = 3, .corners_px = {}};
        for (std::size_t k = 0; k < 4; ++k)
            tag.corners_px[k] = Eigen::Vector2d(200.0, 200.0) + 0.5 * side_px * tag_corners[k];
        const cv::Mat image = draw({tag}, {400, 400}, blur_px, random);
        const auto found = TagDetector(machine_camera_options(reading)).detect(image, 0);
        ASSERT_EQ(found.size(), 1U) << text_of(reading.print);
        const TagAppearance seen = tag_appearance(image, found.front());
        double variance_px2 = 0.0;
        for (const TagSide& side : seen.sides) variance_px2 += 0.25 * side.variance_px2;
        if (reading == TagReading{}) usual_px2 = variance_px2;
        EXPECT_NEAR(variance_px2, usual_px2, 4.0 * seen.sides[0].variance_std_px2) << text_of(reading.print);
        EXPECT_NEAR(variance_px2, blur_px * blur_px + 1.0 / 12.0, 0.2) << text_of(reading.print);
    }
}

}  // namespace
}  // namespace fidservo::vision
