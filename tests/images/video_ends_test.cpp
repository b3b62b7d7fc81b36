// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of frames that are missing, hidden or damaged, and of pixels that are not square.
#include "src/images/image_frames.h"
#include "tests/images/film.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

using ::testing::ElementsAre;
using testing::Film;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;

constexpr int darkest = 20, step = 9;

/// Frames with noise, each as bright as its number says.
Film film_of(int count, const std::string& codec) {
    Film film;
    film.codec = codec;
    film.unit_ms = 40;
    for (int k = 0; k < count; ++k) {
        cv::Mat grey(48, 64, CV_8UC1);
        cv::RNG(static_cast<std::uint64_t>(k + 1))
            .fill(grey, cv::RNG::UNIFORM, darkest + step * k - 6, darkest + step * k + 7);
        film.frames.push_back(grey);
        film.times.push_back(k);
    }
    return film;
}

std::vector<std::string> notes_of(const std::filesystem::path& file) {
    return ImageFrames({file}).notes();
}

TEST(VideoEnds, FramesThatAnEditListHides_AreNotCalledMissing) {
    const TemporaryFolder folder;
    Film film = film_of(8, "mpeg4");
    for (std::int64_t& time : film.times) time -= 3;
    write_film(folder / "a.mp4", film);
    EXPECT_THAT(
        notes_of(folder / "a.mp4"),
        ElementsAre(HasSubstr("passed over: 3 of its 8 frames, which its container marks as not shown")));
}

TEST(VideoEnds, HeaderThatCountsMoreFrames_IsQuotedWithoutACause) {
    const TemporaryFolder folder;
    write_film(folder / "a.avi", film_of(6, "mjpeg"));
    std::string bytes = testing::text_of(folder / "a.avi");
    constexpr std::size_t count_behind_name = 40;  // of a stream's header: its length in frames
    bytes[bytes.find("strh") + count_behind_name] = 60;
    folder.write("a.avi", bytes);
    EXPECT_THAT(notes_of(folder / "a.avi"),
                ElementsAre(HasSubstr("it holds 6 frames where its header says 60")));
}

TEST(VideoEnds, CutShort_IsSaidOfEveryContainerThatCanTell) {
    const TemporaryFolder folder;
    constexpr int of_several_pages = 60;
    Film film = film_of(of_several_pages, "libtheora");
    write_film(folder / "a.ogv", film);
    film.codec = "mjpeg";
    write_film(folder / "a.avi", film);
    write_film(folder / "a.mkv", film);
    for (const char* name : {"a.ogv", "a.avi", "a.mkv"}) {
        EXPECT_THAT(notes_of(folder / name), IsEmpty()) << name;
        const std::string bytes = testing::text_of(folder / name);
        folder.write(name, bytes.substr(0, bytes.size() * 9 / 10));
        EXPECT_THAT(notes_of(folder / name), ElementsAre(HasSubstr("bytes are missing"))) << name;
    }
}

TEST(VideoEnds, OggWithoutItsLastPage_IsSaid) {
    const TemporaryFolder folder;
    constexpr int of_several_pages = 60;
    write_film(folder / "a.ogv", film_of(of_several_pages, "libtheora"));
    const std::string bytes = testing::text_of(folder / "a.ogv");
    folder.write("a.ogv", bytes.substr(0, bytes.rfind("OggS")));
    EXPECT_THAT(notes_of(folder / "a.ogv"), ElementsAre(HasSubstr("not marked as the end of a stream")));
}

TEST(VideoEnds, PixelsThatAreNotSquare_AreSaid) {
    const TemporaryFolder folder;
    Film film = film_of(2, "ffv1");
    film.pixel_width = 16;
    film.pixel_height = 15;
    write_film(folder / "a.mkv", film);
    EXPECT_THAT(notes_of(folder / "a.mkv"),
                ElementsAre(HasSubstr("its pixels are stated to be 16:15 in width and height")));
}

/// Bits are wrong before the second frame that builds on no other; those behind it are whole.
TEST(VideoEnds, DamagedFrame_IsCountedOnceAndMovesNoOther) {
    const TemporaryFolder folder;
    constexpr std::size_t count = 20, whole_from = 15;
    std::size_t with_damage = 0;
    for (const int between : {0, 2}) {
        Film film = film_of(count, "mpeg4");
        film.frames_between = between;
        write_film(folder / "a.avi", film);
        const std::string bytes = testing::text_of(folder / "a.avi");
        std::mt19937 random(20261130);
        for (int trial = 0; trial < 30; ++trial) {
            std::string damaged = bytes;
            damaged[bytes.size() / 4 + random() % (bytes.size() / 4)] ^=
                static_cast<char>(1U << random() % 8);
            folder.write("a.avi", damaged);
            ImageFrames frames({folder / "a.avi"});
            if (frames.size() != count) continue;  // the container's own structure is hit: it says so
            std::vector<ImageFrame> all;
            while (auto frame = frames.next()) all.push_back(*std::move(frame));
            ASSERT_EQ(all.size(), count) << "trial " << trial;
            for (std::size_t k = whole_from; k < count; ++k) {
                ASSERT_EQ(all[k].damage, "") << "trial " << trial << ", frame " << k;
                EXPECT_NEAR((cv::mean(all[k].decoded)[0] - darkest) / step, static_cast<double>(k), 0.4)
                    << "trial " << trial;
            }
            with_damage += std::ranges::all_of(all, &std::string::empty, &ImageFrame::damage) ? 0 : 1;
        }
    }
    EXPECT_GT(with_damage, 10U);
}

}  // namespace
}  // namespace fidservo
