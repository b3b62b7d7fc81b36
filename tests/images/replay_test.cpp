// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo replay on what other programs write: displacements that are known, and what is said.
#include "core/tag_families.h"
#include "tests/images/film.h"
#include "tests/images/written_tiff.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramRun;
using testing::TemporaryFolder;

constexpr int cell_px = 20, steps_px = 8;
constexpr double side_um = 1200.0, step_um = steps_px * side_um / (8 * cell_px);

/// A tag, moved to the right by so many steps.
cv::Mat tag_image(int steps) {
    constexpr int tag = 40, edge_px = 40;
    const TagPattern pattern = tag_pattern(TagPrint{}, tag);
    cv::Mat image(8 * cell_px + 2 * edge_px, 8 * cell_px + 2 * edge_px + 100, CV_8UC1, cv::Scalar(230));
    for (int row = 0; row < pattern.cells; ++row)
        for (int column = 0; column < pattern.cells; ++column)
            image(cv::Rect(edge_px + steps * steps_px + column * cell_px, edge_px + row * cell_px, cell_px,
                           cell_px))
                .setTo(pattern[cell_at(row, column, pattern.cells)] ? 230 : 25);
    cv::GaussianBlur(image, image, {0, 0}, 0.8);
    return image;
}

/// First column and dx of displacements.csv.
std::vector<std::pair<std::string, double>> displacements(const fs::path& folder) {
    std::istringstream lines(testing::text_of(folder / "displacements.csv"));
    std::vector<std::pair<std::string, double>> rows;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        std::string key, tag, dx;
        std::getline(fields, key, ',');
        std::getline(fields, tag, ',');
        std::getline(fields, dx, ',');
        rows.emplace_back(key, std::stod(dx));
    }
    return rows;
}

class ReplayOf : public ::testing::Test {
  protected:
    TemporaryFolder folder;

    ProgramRun replay(const std::string& input, const std::vector<std::string>& more = {}) const {
        std::error_code ignored;
        fs::remove_all(folder / "out", ignored);
        std::vector<std::string> arguments{"replay", input, "--out", "out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return testing::run_program(arguments, folder.path());
    }

    void save(const fs::path& file, const cv::Mat& image) const {
        fs::create_directories((folder / file).parent_path());
        ASSERT_TRUE(cv::imwrite((folder / file).string(), image));
    }

    void expect_steps(const std::vector<int>& steps) const {
        const auto rows = displacements(folder / "out");
        ASSERT_EQ(rows.size(), steps.size());
        for (std::size_t k = 0; k < rows.size(); ++k)
            EXPECT_NEAR(rows[k].second, step_um * steps[k], 0.05) << rows[k].first;
    }
};

TEST_F(ReplayOf, Video_HasEachFramesOwnTime) {
    testing::Film film;
    film.times = {0, 40, 120, 400, 1000, 1100};
    for (int k = 0; k < 6; ++k) film.frames.push_back(tag_image(k));
    write_film(folder / "a.mkv", film);
    EXPECT_EQ(replay("a.mkv").exit_code, 0);
    expect_steps({0, 1, 2, 3, 4, 5});
    const auto rows = displacements(folder / "out");
    for (std::size_t k = 0; k < rows.size(); ++k)
        EXPECT_EQ(rows[k].first, fmt::format("{}", film.times[k] * 1'000'000));
}

TEST_F(ReplayOf, FolderOfNumberedFrames_IsInTheirOrder) {
    save("f/frame1.png", cv::Mat(240, 340, CV_8UC1, cv::Scalar(200)));
    for (int k = 0; k < 11; ++k) save(fmt::format("f/frame{}.png", k + 2), tag_image(k));
    EXPECT_EQ(replay("f").exit_code, 0);
    expect_steps({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
}

TEST_F(ReplayOf, TenAndTwelveBitsInSixteen_AreMeasuredAsEightAre) {
    for (const int bits : {8, 10, 12, 16}) {
        for (int k = 0; k < 2; ++k) {
            cv::Mat deep;
            tag_image(k).convertTo(deep, CV_16U, ((1 << bits) - 1) / 255.0);
            save(fmt::format("b{}/f{}.png", bits, k), deep);
        }
        const ProgramRun run = replay(fmt::format("b{}", bits));
        EXPECT_THAT(run.err,
                    HasSubstr(fmt::format("{} of 16 bits are used: {} is white", bits, (1 << bits) - 1)));
        expect_steps({0, 1});
    }
}

TEST_F(ReplayOf, StackOfPages_IsAFrameAPage) {
    std::vector<testing::TiffPage> pages(4);
    for (int k = 0; k < 4; ++k) tag_image(k).convertTo(pages[static_cast<std::size_t>(k)].samples, CV_16U);
    write_tiff(folder / "stack.tif", "w", pages);
    EXPECT_EQ(replay("stack.tif").exit_code, 0);
    expect_steps({0, 1, 2, 3});
    EXPECT_EQ(displacements(folder / "out")[2].first, "stack.tif#2");
}

TEST_F(ReplayOf, FramesMissingAndDamaged_AreNamedAndTheOthersMeasured) {
    std::string index = "#timestamp [ns],filename\n";
    for (int k = 0; k < 5; ++k) {
        index += fmt::format("{},{}.png\n", 20'000'000 * (k + 1), k);
        if (k != 3) save(fmt::format("r/mav0/cam0/data/{}.png", k), tag_image(k));
    }
    const std::string whole = testing::text_of(folder / "r/mav0/cam0/data/1.png");
    folder.write("r/mav0/cam0/data/1.png", whole.substr(0, whole.size() / 2));
    folder.write("r/mav0/cam0/data.csv", index);
    const ProgramRun run = replay("r");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("3 of 5 images; 1 damaged: 1.png; 1 listed and not there: 3.png"));
    expect_steps({0, 2, 4});
}

TEST_F(ReplayOf, NothingThatCanBeRead_IsWrongInputAndLeavesNothing) {
    folder.write("f/a.png", "no");
    folder.write("f/b.png", "no");
    const ProgramRun run = replay("f");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err,
                HasSubstr("0 of 2 images; 2 damaged: a.png, b.png; the first: f/a.png: cannot be read"));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(ReplayOf, FolderOfManyFormats_IsReadWhole) {
    const char* names[] = {"f0.png", "f1.pgm", "f2.webp", "f3.jp2", "f4.bmp"};
    for (int k = 0; k < 5; ++k) save(fs::path("f") / names[k], tag_image(k));
    folder.write("f/notes.txt", "notes");
    const ProgramRun run = replay("f");
    EXPECT_THAT(run.out, HasSubstr("5 tags in 5 images"));
    EXPECT_THAT(run.err, HasSubstr("f: passed over: notes.txt"));
    const auto rows = displacements(folder / "out");
    ASSERT_EQ(rows.size(), 5U);
    for (int k = 0; k < 5; ++k)  // WebP loses a little
        EXPECT_NEAR(rows[static_cast<std::size_t>(k)].second, k * step_um, k == 2 ? 1.0 : 0.05);
}

TEST_F(ReplayOf, ImagesGivenByName_AreMeasuredFromTheFirst) {
    for (int k = 0; k < 3; ++k) save(fmt::format("f{}.png", k), tag_image(k));
    EXPECT_EQ(replay("f0.png", {"f1.png", "f2.png"}).exit_code, 0);
    expect_steps({0, 1, 2});
}

TEST_F(ReplayOf, DamagedImage_IsOneLine) {
    save("f/a.png", tag_image(0));
    save("f/b.bmp", tag_image(0));
    std::string bitmap = testing::text_of(folder / "f/b.bmp");
    constexpr std::size_t colours_at = 46;
    bitmap[colours_at + 2] = 0x7f;  // its header counts millions of colours, which OpenCV does not bear
    folder.write("f/b.bmp", bitmap);
    const ProgramRun run = replay("f");
    EXPECT_THAT(run.out, HasSubstr("1 of 2 images; 1 damaged: b.bmp"));
    EXPECT_THAT(run.err, Not(HasSubstr("OpenCV")));
}

TEST_F(ReplayOf, FolderNamedByTimes_HasThem) {
    for (int k = 0; k < 2; ++k) save(fmt::format("k/cam0/14036365797635555{:02}.png", 84 + k), tag_image(k));
    const ProgramRun run = replay("k");
    EXPECT_THAT(run.err, HasSubstr("times are those in the names, in ns"));
    expect_steps({0, 1});
    EXPECT_EQ(displacements(folder / "out")[1].first, "1403636579763555585");
    EXPECT_EQ(replay("k", {"--name-times", "none"}).exit_code, 0);
    EXPECT_THAT(displacements(folder / "out")[1].first, HasSubstr(".png"));
    const ProgramRun wrong = replay("k", {"--name-times", "minutes"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--name-times: minutes: must be none, s, ms, us or ns"));
}

}  // namespace
}  // namespace fidservo
