// SPDX-License-Identifier: GPL-3.0-or-later
// Tags that were not looked for as what they are: the hint names how they would be found.
#include "vision/tags/other_readings.h"

#include "tests/effort.h"
#include "tests/tags/drawn_tag.h"
#include "tests/variations.h"
#include "vision/tags/square_outlines.h"
#include "vision/tags/tag_detector.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using fidservo::testing::between;
using fidservo::testing::draw;
using fidservo::testing::DrawnTag;
using fidservo::testing::one_of;
using fidservo::testing::random_corners;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TagReading unusual_reading(std::mt19937_64& random) {
    TagReading reading;
    while (reading == TagReading{}) {
        reading.print = fidservo::testing::random_print(random);
        if (reading.print.family->has_plain_border()) reading.print.border_cells = 1 + one_of(2, random);
        reading.print.inverted = one_of(3, random) == 0;
        reading.mirrored = one_of(3, random) == 0;
    }
    return reading;
}

struct Picture {
    std::vector<DrawnTag> tags;
    cv::Mat1b image;
};

/// Four tags side by side, ids all different.
Picture picture_of(const TagReading& reading, std::mt19937_64& random) {
    constexpr int columns = 2, rows = 2;
    const auto size = fidservo::testing::size_of(reading.print);
    const double cell_px = between(4.0, 6.0, random);
    const double pitch_px = 1.7 * cell_px * (size.all + 2);
    Picture picture;
    const int first_id = one_of(reading.print.family->size() - columns * rows, random);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            picture.tags.push_back(
                {.reading = reading,
                 .id = first_id + row * columns + column,
                 .corners_px = random_corners({(column + 0.5) * pitch_px, (row + 0.5) * pitch_px},
                                              cell_px * size.outline, reading.mirrored, random)});
    picture.image =
        draw(picture.tags, {static_cast<int>(columns * pitch_px), static_cast<int>(rows * pitch_px)},
             between(0.6, 1.0, random), random);
    return picture;
}

/// How many tags are where they were drawn; none may be anything else.
std::size_t right_tags(const Picture& picture, const TagReading& reading, std::string& wrong) {
    std::size_t right = 0;
    for (const TagDetection& tag : TagDetector(thorough_options(reading)).detect(picture.image, 0)) {
        const auto drawn = std::ranges::find(picture.tags, tag.tag_id, &DrawnTag::id);
        if (drawn != picture.tags.end() && (drawn->corners_px[0] - tag.corners_px[0]).norm() < 1.5)
            ++right;
        else
            wrong += fmt::format("{}{} {} is not there; ", reading.mirrored ? "mirrored " : "",
                                 text_of(reading.print), tag.tag_id);
    }
    return right;
}

TEST(SlowOtherReadings, TagsOfAnyOtherKind_AreFoundByTheReadingThatIsNamed) {
    const TagDetector keeps_its_book(thorough_options());
    expect_right_or_refused("hints", fidservo::testing::draws(200, 40), [](std::mt19937_64& random) {
        const TagReading reading = unusual_reading(random);
        const Picture picture = picture_of(reading, random);
        const std::string name = fmt::format("{}{} from {}", reading.mirrored ? "mirrored " : "",
                                             text_of(reading.print), picture.tags.front().id);
        std::string wrong;
        (void)right_tags(picture, {}, wrong);
        const std::vector<cv::Mat> images{picture.image};
        if (!looks_unread(picture.image, 0)) wrong += "no squares are seen; ";
        const OtherReadings others = try_other_readings(images, {});
        if (!wrong.empty()) return Outcome::wrong(name + ": " + wrong);
        if (others.better.empty()) return Outcome::refused(name + ": " + text_of(others.seen, {}));
        const TriedReading& best = others.better.front();
        const std::size_t right = right_tags(picture, best.reading, wrong);
        if (!wrong.empty()) return Outcome::wrong(name + ": " + wrong);
        if (right != best.tags || right + 1 < picture.tags.size())
            return Outcome::wrong(fmt::format("{}: {} said, {} right", name, best.tags, right));
        return Outcome::right();
    });
}

TEST(OtherReadings, UsualTags_HaveNoBetterReading) {
    std::mt19937_64 random(3);
    const Picture picture = picture_of({}, random);
    const std::vector<cv::Mat> images{picture.image};
    const OtherReadings others = try_other_readings(images, {});
    EXPECT_EQ(others.tags, picture.tags.size());
    EXPECT_THAT(others.better, SizeIs(0));
    EXPECT_FALSE(looks_unread(picture.image, picture.tags.size()));
}

TEST(OtherReadings, NumberOfTagsThatIsKnown_IsNotCountedAgain) {
    std::mt19937_64 random(3);
    const Picture picture = picture_of({{.border_cells = 2}, false}, random);
    const std::vector<cv::Mat> images{picture.image};
    EXPECT_THAT(try_other_readings(images, {}, 0).better, SizeIs(1));
    const OtherReadings others = try_other_readings(images, {}, picture.tags.size());
    EXPECT_EQ(others.tags, picture.tags.size());
    EXPECT_THAT(others.better, SizeIs(0)) << "as many were found";
}

/// Wider borders and small families explain part of the same squares by chance.
TEST(OtherReadings, OfTheSameSquares_AreOneAlone) {
    for (const TagReading& reading_of_print : {TagReading{{.inverted = true}, false}, TagReading{{}, true},
                                               TagReading{{.inverted = true}, true}}) {
        cv::Mat1b image(240, 320, static_cast<unsigned char>(255));
        cv::Mat1b large;
        cv::resize(fidservo::testing::cells_of({}, 7), large, {}, 12.0, 12.0, cv::INTER_NEAREST);
        large.copyTo(image(cv::Rect(100, 60, large.cols, large.rows)));
        if (reading_of_print.print.inverted) image = cv::Mat1b(255 - image);
        if (reading_of_print.mirrored) cv::flip(image, image, 1);
        const std::vector<cv::Mat> images{image};
        const OtherReadings others = try_other_readings(images, {});
        ASSERT_THAT(others.better, SizeIs(1));
        EXPECT_TRUE(others.better.front().reading == reading_of_print);
        EXPECT_EQ(others.better.front().tags, 1u);
    }
}

TEST(ImagesSeen, WithoutTags_NamesOnlyWhatWasChecked) {
    const auto said = [](const cv::Mat& image) {
        const std::vector<cv::Mat> images{image};
        const OtherReadings others = try_other_readings(images, {});
        EXPECT_TRUE(others.better.empty());
        return text_of(others.seen, {});
    };
    EXPECT_THAT(said(cv::Mat1b(200, 300, static_cast<unsigned char>(120))),
                HasSubstr("uniform, grey levels 120 to 120"));
    EXPECT_THAT(said(cv::Mat1b(200, 300, static_cast<unsigned char>(255))),
                HasSubstr("100 % of the pixels are saturated"));
    std::mt19937_64 random(4);
    Picture dark = picture_of({}, random);
    dark.image *= 0.02;
    EXPECT_THAT(said(dark.image), HasSubstr("uniform"));

    Picture faint = picture_of({}, random);
    cv::GaussianBlur(faint.image, faint.image, {}, 5.0);
    EXPECT_THAT(said(faint.image), HasSubstr("blur"));

    cv::Mat1b squares(240, 320, static_cast<unsigned char>(200));
    for (int k = 0; k < 3; ++k) squares(cv::Rect(20 + 100 * k, 60, 60, 60)).setTo(40);
    EXPECT_THAT(said(squares),
                HasSubstr("3 squares with four straight sides, 0 of them with something inside; "
                          "typically 59 px a side, contrast 160 grey levels"));
}

TEST(SquareOutlines, OfDrawnTags_HaveTheirSizeContrastAndBlur) {
    std::mt19937_64 random(8);
    const Picture picture = picture_of({}, random);
    std::vector<SquareOutline> outlines = square_outlines(picture.image);
    std::erase_if(outlines, [](const SquareOutline& outline) { return !outline.has_pattern; });
    for (const DrawnTag& tag : picture.tags) {
        const Eigen::Vector2d middle =
            0.25 * (tag.corners_px[0] + tag.corners_px[1] + tag.corners_px[2] + tag.corners_px[3]);
        const double side_px = (tag.corners_px[0] - tag.corners_px[1]).norm();
        EXPECT_TRUE(std::ranges::any_of(outlines, [&](const SquareOutline& seen) {
            Eigen::Vector2d centre = Eigen::Vector2d::Zero();
            for (const auto& corner : seen.corners_px) centre += 0.25 * corner;
            return (centre - middle).norm() < 3.0 && std::abs(seen.side_px / side_px - 1.0) < 0.15;
        }));
    }
}

}  // namespace
}  // namespace fidservo::vision
