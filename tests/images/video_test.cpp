// SPDX-License-Identifier: GPL-3.0-or-later
// Videos: each frame with its own time stamp, or none has one.
#include "src/images/image_frames.h"
#include "tests/images/film.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::Film;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TemporaryFolder;

constexpr int darkest = 20, step = 12;

/// The frame's number is its grey.
cv::Mat numbered(int number) {
    cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(darkest + step * number));
    return grey;
}

Film film_of(std::vector<std::int64_t> times, const std::string& codec = "ffv1") {
    Film film;
    film.codec = codec;
    for (int k = 0; k < static_cast<int>(times.size()); ++k) film.frames.push_back(numbered(k));
    film.times = std::move(times);
    return film;
}

int number_of(const cv::Mat& grey) {
    return static_cast<int>(std::lround((cv::mean(grey)[0] - darkest) / step));
}

TEST(Video, UnevenTimes_AreEachFramesOwn) {
    const TemporaryFolder folder;
    write_film(folder / "a.mkv", film_of({0, 40, 120, 400, 1000, 1100}));
    ImageFrames frames({folder / "a.mkv"});
    EXPECT_EQ(frames.size(), 6U);
    EXPECT_TRUE(frames.is_one_timed_series());
    std::vector<TimeNs> times_ms;
    while (auto frame = frames.next()) {
        ASSERT_TRUE(load(*frame)) << frame->damage;
        EXPECT_EQ(number_of(frame->decoded), static_cast<int>(times_ms.size()));
        times_ms.push_back(*frame->time_ns / ns_per_ms);
    }
    EXPECT_THAT(times_ms, ElementsAre(0, 40, 120, 400, 1000, 1100));
    EXPECT_THAT(frames.notes(), IsEmpty());
}

TEST(Video, StreamWithoutTimeStamps_HasNoTimes) {
    const TemporaryFolder folder;
    write_film(folder / "a.mjpeg", film_of({0, 1, 2}, "mjpeg"));
    ImageFrames frames({folder / "a.mjpeg"});
    EXPECT_FALSE(frames.is_one_timed_series());
    EXPECT_THAT(frames.notes(), ElementsAre(HasSubstr("no times are taken: the stream has no time stamps")));
    for (int k = 0; k < 3; ++k) {
        const auto frame = frames.next();
        ASSERT_TRUE(frame);
        EXPECT_FALSE(frame->time_ns);
        EXPECT_EQ(number_of(frame->decoded), k);
        EXPECT_THAT(frame->name, HasSubstr(fmt::format("a.mjpeg#{}", k)));
    }
    EXPECT_FALSE(frames.next());
}

TEST(Video, TimesThatDoNotRise_AreNotTaken) {
    const TemporaryFolder folder;
    write_film(folder / "a.mkv", film_of({0, 40, 40, 80}));
    ImageFrames frames({folder / "a.mkv"});
    EXPECT_FALSE(frames.is_one_timed_series());
    EXPECT_THAT(frames.notes(), ElementsAre(HasSubstr("its time stamps do not rise from frame to frame")));
    EXPECT_FALSE(frames.next()->time_ns);
}

TEST(Video, DisplayMatrix_IsNotFollowedAndSaid) {
    const TemporaryFolder folder;
    Film film = film_of({0, 40}, "mpeg4");
    film.is_turned = true;
    write_film(folder / "a.mp4", film);
    ImageFrames frames({folder / "a.mp4"});
    EXPECT_THAT(frames.notes(), Contains(HasSubstr("players turn its picture")));
    EXPECT_EQ(frames.next()->decoded.size(), cv::Size(64, 48));
}

TEST(Video, TwelveOfSixteenBits_AreTheWholeRange) {
    const TemporaryFolder folder;
    Film film;
    for (const int value : {500, 4095})
        film.frames.emplace_back(cv::Mat(48, 64, CV_16UC1, cv::Scalar(value)));
    film.times = {0, 40};
    write_film(folder / "a.mkv", film);
    ImageFrames frames({folder / "a.mkv"});
    EXPECT_THAT(frames.notes(), Contains(HasSubstr("12 of 16 bits are used")));
    EXPECT_EQ(frames.next()->decoded.at<unsigned char>(9, 9), std::lround(500 * 255.0 / 4095.0));
    EXPECT_EQ(frames.next()->decoded.at<unsigned char>(9, 9), 255);
}

TEST(Video, LumaOfTelevision_IsStretchedToTheWholeRange) {
    const TemporaryFolder folder;
    Film film;
    film.codec = "mpeg4";
    for (const int grey : {0, 128, 255}) film.frames.emplace_back(cv::Mat(48, 64, CV_8UC1, cv::Scalar(grey)));
    film.times = {0, 1, 2};
    film.unit_ms = 40;
    write_film(folder / "a.mp4", film);
    ImageFrames frames({folder / "a.mp4"});
    for (const double grey : {0.0, 128.0, 255.0}) EXPECT_NEAR(cv::mean(frames.next()->decoded)[0], grey, 3.0);
}

TEST(Video, WhatIsNone_IsRefusedInOneLine) {
    const TemporaryFolder folder;
    folder.write("text.mp4", "this is no film");
    folder.write("empty.avi", "");
    folder.write("sound.mov",
                 std::string("RIFF\x28\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x40\x1f\0\0\x40\x1f\0\0\1\0\x08\0"
                             "data\4\0\0\0\1\2\3\4",
                             48));
    EXPECT_THAT(message_of([&] { ImageFrames({folder / "sound.mov"}); }), HasSubstr("no stream of pictures"));
    for (const char* name : {"text.mp4", "empty.avi"})
        EXPECT_THAT(message_of([&] { ImageFrames({folder / name}); }),
                    HasSubstr(fmt::format("{}: cannot be read as a video", name)));
}

TEST(Video, CutShort_IsSaid) {
    const TemporaryFolder folder;
    for (const char* name : {"a.mkv", "a.avi"}) {
        write_film(folder / name, film_of({0, 40, 80, 120, 160, 200}, "mjpeg"));
        const std::string bytes = testing::text_of(folder / name);
        folder.write(name, bytes.substr(0, bytes.size() / 2));
        const ImageFrames frames({folder / name});
        EXPECT_THAT(frames.notes(), Contains(HasSubstr("it is cut short"))) << name;
    }
}

struct Kind {
    const char* file;
    const char* codec;
    bool has_free_times;  ///< not only multiples of the frame's duration from 0 on
};

constexpr Kind kinds[] = {{"a.mkv", "ffv1", true},    {"a.mkv", "mjpeg", true},    {"a.mkv", "mpeg4", true},
                          {"a.mov", "mjpeg", true},   {"a.mp4", "mpeg4", true},    {"a.avi", "mjpeg", false},
                          {"a.avi", "ffv1", false},   {"a.mjpeg", "mjpeg", false}, {"a.mkv", "libx264", true},
                          {"a.mp4", "libx264", true}, {"a.h264", "libx264", false}};

Outcome judged_times(std::mt19937_64& random) {
    const TemporaryFolder folder;
    const Kind& kind = kinds[random() % std::size(kinds)];
    std::vector<std::int64_t> times;
    const int count = 1 + static_cast<int>(random() % 15);
    std::int64_t at = kind.has_free_times ? static_cast<std::int64_t>(random() % 3) * 500 : 0;
    bool rise = true;
    for (int k = 0; k < count; ++k) {
        times.push_back(at);
        const bool stands =
            kind.has_free_times && std::string(kind.codec) == "ffv1" && random() % 20 == 0 && k + 1 < count;
        rise = rise && !stands;
        at += stands ? 0 : kind.has_free_times ? 1 + static_cast<std::int64_t>(random() % 300) : 1;
    }
    Film film = film_of(times, kind.codec);
    film.unit_ms = kind.has_free_times ? 1 : 10 + static_cast<int>(random() % 90);
    write_film(folder / kind.file, film);
    ImageFrames frames({folder / kind.file});
    const bool has_times = frames.is_one_timed_series();
    const bool raw = std::string(kind.file) == "a.mjpeg" || std::string(kind.file) == "a.h264";
    if (raw && has_times) return Outcome::wrong("times of a stream without any");
    if (!raw && has_times != rise)
        return Outcome::wrong(fmt::format("{}: has times: {}", kind.file, has_times));
    for (int k = 0; k < count; ++k) {
        const auto frame = frames.next();
        if (!frame)
            return Outcome::wrong(fmt::format("{} {}: {} of {} frames", kind.file, kind.codec, k, count));
        if (!frame->damage.empty()) return Outcome::wrong(frame->damage);
        if (number_of(frame->decoded) != k) return Outcome::wrong("another frame");
        if (has_times && *frame->time_ns != times[static_cast<std::size_t>(k)] * film.unit_ms * ns_per_ms)
            return Outcome::wrong(fmt::format("{} {}: frame {}: {} in place of {} ms", kind.file, kind.codec,
                                              k, *frame->time_ns / ns_per_ms,
                                              times[static_cast<std::size_t>(k)] * film.unit_ms));
        if (!has_times && frame->time_ns) return Outcome::wrong("a time in a series without times");
    }
    return frames.next() ? Outcome::wrong("too many frames") : Outcome::right();
}

TEST(VideoVariations, TimesOfFrames_AreThoseThatWereWritten) {
    expect_right_or_refused("times of a video's frames, by container and codec", 200, judged_times);
}

/// A video of which bytes are wrong: what comes out is one of its frames, with that frame's time, or damaged.
Outcome judged_damage_of_video(std::mt19937_64& random) {
    const TemporaryFolder folder;
    constexpr const char* codecs[] = {"ffv1", "mjpeg", "libx264"};
    Film film = film_of({0, 40, 80, 120, 160, 200, 240, 280}, codecs[random() % std::size(codecs)]);
    // Noise makes the frames' data so long that few of the wrong bytes are in the headers.
    for (cv::Mat& frame : film.frames) {
        cv::Mat noise(frame.size(), CV_8SC1);
        cv::RNG(random()).fill(noise, cv::RNG::UNIFORM, -5, 6);
        cv::add(frame, noise, frame, cv::noArray(), CV_8U);
    }
    write_film(folder / "a.mkv", film);
    std::string bytes = testing::text_of(folder / "a.mkv");
    const bool cut = random() % 2 == 0;
    if (cut)
        bytes.resize(bytes.size() / 3 + random() % (bytes.size() / 2));
    else
        for (int k = 0; k < 4; ++k)
            bytes[bytes.size() / 3 + random() % (bytes.size() / 2)] ^= static_cast<char>(1 + random() % 255);
    folder.write("a.mkv", bytes);
    try {
        ImageFrames frames({folder / "a.mkv"});
        const bool timed = frames.is_one_timed_series();
        TimeNs last_ns = -1;
        std::size_t read = 0, damaged = 0;
        while (const auto frame = frames.next()) {
            if (!frame->damage.empty()) {
                ++damaged;
                continue;
            }
            ++read;
            if (frame->decoded.size() != cv::Size(64, 48)) return Outcome::wrong("another size");
            if (timed && *frame->time_ns <= last_ns) return Outcome::wrong("times do not rise");
            if (timed) last_ns = *frame->time_ns;
            if (cut && timed && *frame->time_ns != number_of(frame->decoded) * 40 * ns_per_ms)
                return Outcome::wrong("a frame with another's time");
        }
        if (cut && read == film.frames.size() && damaged == 0)
            return Outcome::right();  // only its index is lost
        if (cut && damaged == 0 && frames.notes().empty())
            return Outcome::wrong("nobody says that it is cut short");
        return Outcome::right();
    } catch (const std::exception& error) {
        return Outcome::refused(error.what());
    }
}

TEST(VideoVariations, DamagedVideos_AreReadAsFarAsTheyGo) {
    expect_right_or_refused("damage of a video: cut short or wrong bytes", 200, judged_damage_of_video);
}

}  // namespace
}  // namespace fidservo
