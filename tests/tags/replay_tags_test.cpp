// SPDX-License-Identifier: GPL-3.0-or-later
// Images of tags that are not printed as usual, by way of the program.
#include "src/calibrate/camera_images.h"
#include "src/replay/unread_tags.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"
#include "tests/tags/drawn_tag.h"

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

using testing::DrawnTag;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::Not;
using testing::ProgramRun;
using testing::run_program;
using testing::TemporaryFolder;

/// A grid as kalibr's: black squares touch the corners of tags with a border of two cells.
std::vector<DrawnTag> grid_of(int columns, int rows, double side_px, const vision::TagReading& reading) {
    std::vector<DrawnTag> tags;
    const double pitch_px = (reading.print.family->has_plain_border() ? 1.3 : 2.2) * side_px;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            DrawnTag tag{.reading = reading, .id = row * columns + column, .corners_px = {}};
            const Eigen::Vector2d centre_px((column + 0.7) * pitch_px, (rows - row - 0.3) * pitch_px);
            const double x_sign = reading.mirrored ? -1.0 : 1.0;
            for (std::size_t k = 0; k < 4; ++k)
                tag.corners_px[k] =
                    centre_px +
                    0.5 * side_px * Eigen::Vector2d(x_sign * tag_corners[k].x(), tag_corners[k].y());
            tag.corner_squares = reading.print.border_cells == 2;
            tags.push_back(tag);
        }
    return tags;
}

/// An image of twelve tags.
void write_image(const std::filesystem::path& file, const vision::TagReading& reading) {
    std::mt19937_64 random(7);
    const bool plain = reading.print.family->has_plain_border();
    const double side_px = plain ? 60.0 : 40.0;
    cv::imwrite(file.string(), draw(grid_of(4, 3, side_px, reading),
                                    plain ? cv::Size(360, 280) : cv::Size(400, 310), 0.8, random));
}

TEST(ReplayTags, AprilGrid_IsFoundByTheOptionThatTheHintNames) {
    const TemporaryFolder folder;
    write_image(folder / "grid.png", {{&usual_tag_family(), 2}});
    const ProgramRun blind = run_program({"replay", "grid.png", "--out", "a"}, folder.path());
    EXPECT_EQ(blind.exit_code, 0) << blind.err;
    EXPECT_THAT(
        blind.out,
        HasSubstr("12 tags of tag36h11 with a border of two cells would be found: --border-cells 2\n"));
    const ProgramRun seeing =
        run_program({"replay", "grid.png", "--out", "b", "--border-cells", "2"}, folder.path());
    EXPECT_EQ(seeing.exit_code, 0) << seeing.err;
    EXPECT_THAT(seeing.out, HasSubstr("12 tags in 1 image"));
    EXPECT_THAT(seeing.out, Not(HasSubstr("would be")));
}

TEST(SlowReplayTags, OtherFamiliesInvertedAndMirrored_AreFoundByTheOptionsThatTheHintNames) {
    for (const vision::TagReading& reading : {vision::TagReading{{find_tag_family("tag25h9")}},
                                              vision::TagReading{{find_tag_family("tagStandard41h12")}},
                                              vision::TagReading{{find_tag_family("DICT_6X6_50")}, true},
                                              vision::TagReading{{&usual_tag_family(), 1, true}}}) {
        const TemporaryFolder folder;
        write_image(folder / "tags.png", reading);
        const std::string options = options_for(reading, {});
        EXPECT_THAT(run_program({"replay", "tags.png", "--out", "a"}, folder.path()).out,
                    HasSubstr(fmt::format("would be found: {}\n", options)));
        std::vector<std::string> arguments{"replay", "tags.png", "--out", "b"};
        std::istringstream words(options);
        for (std::string word; words >> word;) arguments.push_back(word);
        EXPECT_THAT(run_program(arguments, folder.path()).out, HasSubstr("12 tags in 1 image")) << options;
    }
}

TEST(ReplayTags, NothingThere_SaysWhatIsSeen) {
    const TemporaryFolder folder;
    cv::imwrite((folder / "grey.png").string(), cv::Mat1b(240, 320, static_cast<unsigned char>(90)));
    const ProgramRun run = run_program({"replay", "grey.png", "--out", "a"}, folder.path());
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr("0 tags in 1 image"));
    EXPECT_THAT(run.out, HasSubstr("seen: the images are uniform, grey levels 90 to 90; no square"));
}

TEST(ReplayTags, OptionsThatCannotBe_AreRefusedInOneLine) {
    const TemporaryFolder folder;
    write_image(folder / "tags.png", {});
    const auto error = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"replay", "tags.png", "--out", "a"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProgramRun run = run_program(arguments, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        return run.err;
    };
    EXPECT_THAT(error({"--family", "tag36h12"}),
                HasSubstr("--family: tag36h12: must be one of tag36h11, tag25h9"));
    EXPECT_THAT(error({"--family", "tagStandard41h12", "--border-cells", "2"}),
                HasSubstr("--border-cells: 2: must be 1: tagStandard41h12 has no plain border"));
}

TEST(CalibrateCameraTags, TargetOfAnotherKind_SaysHowItWouldBeFound) {
    const TemporaryFolder folder;
    const CameraTarget plate = plate_target({.print = {},
                                             .side_mm = 1.2,
                                             .pitch_x_mm = 2.0,
                                             .pitch_y_mm = 0.0,
                                             .columns = 9,
                                             .rows = 1,
                                             .first_id = 0});
    write_image(folder / "tags.png", {{find_tag_family("tag25h9")}});
    EXPECT_THAT(message_of([&] { read_calibration_images({folder.path()}, plate); }),
                HasSubstr("12 tags of tag25h9 would be found: give a rig file whose fiducials have "
                          "family: tag25h9"));
    write_image(folder / "tags.png", {{&usual_tag_family(), 1}, true});
    EXPECT_THAT(message_of([&] { read_calibration_images({folder.path()}, plate); }),
                HasSubstr("12 tags of mirrored tag36h11 would be found: mirror the images"));
}

TEST(FrameSample, ManyImages_AreAFewEvenlySpread) {
    FrameSample sample;
    for (std::size_t k = 0; k < 100; ++k) sample.offer({}, k);
    const std::vector<FrameSample::Image>& kept = sample.images();
    ASSERT_GE(kept.size(), 3U);
    ASSERT_LE(kept.size(), 4U);
    EXPECT_EQ(kept[1].tags - kept[0].tags, kept[2].tags - kept[1].tags);
    EXPECT_GT(kept.back().tags, 50U);
}

TEST(FrameSample, TagsOfThoroughSearches_AreCountedWhereAllWereThorough) {
    FrameSample sample;
    sample.offer({}, 3, true);
    sample.offer({}, 4, true);
    EXPECT_EQ(sample.tags_by_thorough_search(), 7U);
    sample.offer({}, 5);
    EXPECT_EQ(sample.tags_by_thorough_search(), std::nullopt);
}

}  // namespace
}  // namespace fidservo
