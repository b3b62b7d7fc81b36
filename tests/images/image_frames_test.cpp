// SPDX-License-Identifier: GPL-3.0-or-later
// What folders, indexes and single files stand for.
#include "src/images/image_frames.h"

#include "src/images/image_tally.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"
#include "vision/images/image_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sys/stat.h>

namespace fidservo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using ::testing::Not;
using testing::TemporaryFolder;

void write_image(const fs::path& file, int grey, int type = CV_8UC1) {
    fs::create_directories(file.parent_path());
    ASSERT_TRUE(cv::imwrite(file.string(), cv::Mat(64, 80, type, cv::Scalar::all(grey)))) << file;
}

/// Grey levels of the frames, -1 for one that cannot be read.
std::vector<int> greys_of(ImageFrames& frames) {
    std::vector<int> greys;
    while (auto frame = frames.next())
        greys.push_back(load(*frame) ? frame->decoded.at<unsigned char>(5, 5) : -1);
    return greys;
}

std::vector<int> greys_of(const fs::path& input) {
    ImageFrames frames({input});
    return greys_of(frames);
}

TEST(ImageFrames, Folder_ComesInNaturalOrderAndSaysWhatItPassesOver) {
    const TemporaryFolder folder;
    for (const int number : {10, 9, 2}) write_image(folder / fmt::format("frame{}.png", number), 10 * number);
    for (const char* name : {"notes.txt", "b.json", "film.avi", ".hidden.png"})
        folder.write(name, "no image");
    fs::create_directory(folder / "more");
    ImageFrames frames({folder.path()});
    EXPECT_EQ(frames.size(), 3U);
    EXPECT_FALSE(frames.is_one_timed_series());
    EXPECT_THAT(greys_of(frames), ElementsAre(20, 90, 100));
    EXPECT_THAT(frames.notes(), ElementsAre(AllOf(HasSubstr("passed over: .hidden.png, b.json, notes.txt"),
                                                  HasSubstr("(5 in all)"))));
}

TEST(ImageFrames, EveryFormatThatIsReadAlone_IsReadInAFolder) {
    const TemporaryFolder folder;
    const std::vector<std::string> endings{"png", "jpg", "jpeg", "jpe", "tif", "tiff",
                                           "bmp", "dib", "webp", "pgm", "pnm", "jp2"};
    for (const std::string& ending : endings) write_image(folder / ("f." + ending), 77);
    write_image(folder / "f.ppm", 77, CV_8UC3);
    write_image(folder / "f.ras", 77, CV_8UC3);
    fs::rename(folder / "f.png", folder / "png-without-ending");
    fs::rename(folder / "f.webp", folder / "webp.image");
    ImageFrames frames({folder.path()});
    EXPECT_EQ(frames.size(), endings.size() + 2);
    for (const int grey : greys_of(frames)) EXPECT_NEAR(grey, 77, 2);
    EXPECT_THAT(frames.notes(), IsEmpty());
    for (const auto& entry : fs::directory_iterator(folder.path()))
        EXPECT_NEAR(greys_of(entry.path()).front(), 77, 2) << entry.path();
}

TEST(ImageFrames, GreySunRaster_IsRefusedRatherThanBlack) {
    const TemporaryFolder folder;
    write_image(folder / "a.ras", 77);
    ImageFrames frames({folder / "a.ras"});
    EXPECT_THAT(message_of([&] { decode(*frames.next()); }), HasSubstr("Sun raster of grey"));
}

TEST(ImageFrames, Recording_HasItsTimesAndItsOrder) {
    const TemporaryFolder folder;
    write_image(folder / "cam0/data/b.png", 1);
    write_image(folder / "cam0/data/a.png", 2);
    folder.write("cam0/data.csv", "#timestamp [ns],filename\n3300000,b.png\n23300000,a.png\n");
    for (const fs::path& input : {folder.path(), folder / "cam0"}) {
        ImageFrames frames({input});
        EXPECT_TRUE(frames.is_one_timed_series());
        auto first = frames.next();
        EXPECT_EQ(first->time_ns, 3300000);
        EXPECT_TRUE(first->from_recording);
        EXPECT_EQ(decode(*first).at<unsigned char>(0, 0), 1);
        EXPECT_THAT(greys_of(frames), ElementsAre(2));
    }
}

TEST(ImageFrames, TumsList_IsFoundInItsFolder) {
    const TemporaryFolder folder;
    write_image(folder / "rgb/1305031102.275326.png", 40);
    write_image(folder / "rgb/1305031102.175304.png", 80);
    write_image(folder / "depth/1305031102.160407.png", 120);
    folder.write("depth.txt", "1305031102.160407 depth/1305031102.160407.png\n");
    folder.write("rgb.txt",
                 "# color images\n# timestamp filename\n"
                 "1305031102.175304 rgb/1305031102.175304.png\n"
                 "1305031102.211214 rgb/1305031102.211214.png\n"
                 "1305031102.275326 rgb/1305031102.275326.png\n");
    ImageFrames frames({folder.path()});
    EXPECT_EQ(frames.size(), 2U);
    EXPECT_TRUE(frames.is_one_timed_series());
    EXPECT_THAT(greys_of(frames), ElementsAre(80, 40));
}

TEST(ImageFrames, FolderOfRecordings_ComesInNaturalOrder) {
    const TemporaryFolder folder;
    for (const int number : {10, 9}) {
        write_image(folder / fmt::format("run{}/cam0/data/a.png", number), number);
        folder.write(fmt::format("run{}/cam0/data.csv", number), "#timestamp [ns],filename\n10,a.png\n");
    }
    EXPECT_THAT(greys_of(folder.path()), ElementsAre(9, 10));
}

TEST(ImageFrames, ImagesGivenByName_AreOneSequenceInTheOrderGiven) {
    const TemporaryFolder folder;
    write_image(folder / "b.png", 1000, CV_16UC1);
    write_image(folder / "a.png", 4000, CV_16UC1);
    write_image(folder / "f/c.png", 9);
    ImageFrames frames({folder / "b.png", folder / "f", folder / "a.png"});
    ASSERT_EQ(frames.series().size(), 2U);
    EXPECT_EQ(frames.series().front().frames, 2U);
    EXPECT_THAT(frames.notes(),
                ElementsAre(HasSubstr("b.png and 1 more given by name: 12 of 16 bits are used")));
    std::vector<std::size_t> series;
    std::vector<int> greys;
    while (auto frame = frames.next()) {
        series.push_back(frame->series);
        greys.push_back(load(*frame) ? frame->decoded.at<unsigned char>(5, 5) : -1);
    }
    EXPECT_THAT(series, ElementsAre(0, 0, 1));
    EXPECT_THAT(greys, ElementsAre(62, 249, 9));
}

TEST(ImageFrames, ImagesGivenByName_HaveTheTimesOfTheirNames) {
    const TemporaryFolder folder;
    const std::vector<fs::path> inputs{folder / "1403636579813555584.png",
                                       folder / "1403636579763555584.png"};
    for (const fs::path& input : inputs) write_image(input, 1);
    ImageFrames frames(inputs);
    EXPECT_TRUE(frames.is_one_timed_series());
    EXPECT_EQ(frames.next()->time_ns, 1403636579763555584);
    EXPECT_FALSE(ImageFrames(inputs, {.name_times = NameTimes::none}).is_one_timed_series());
}

TEST(ImageFrames, Pipe_IsRefusedWithoutWaitingForIt) {
    const TemporaryFolder folder;
    for (const char* name : {"pipe", "pipe.mp4", "pipe.png"}) {
        ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
        EXPECT_THAT(message_of([&] { ImageFrames({folder / name}); }),
                    HasSubstr(fmt::format("{}: it is a pipe, a device or a folder", name)));
    }
    write_image(folder / "cam0/data/a.png", 1);
    ASSERT_EQ(::mkfifo((folder / "cam0/data/b.png").c_str(), 0600), 0);
    folder.write("cam0/data.csv", "#timestamp [ns],filename\n10,a.png\n20,b.png\n");
    EXPECT_THAT(greys_of(folder / "cam0"), ElementsAre(1, -1));
}

TEST(ImageFrames, OneCameraWithoutIndex_IsReadWithTheTimesOfItsNames) {
    const TemporaryFolder folder;
    write_image(folder / "cam0/1403636579813555584.png", 2);
    write_image(folder / "cam0/1403636579763555584.png", 1);
    for (const fs::path& input : {folder.path(), folder / "cam0"}) {
        ImageFrames frames({input});
        EXPECT_TRUE(frames.is_one_timed_series());
        EXPECT_THAT(frames.notes().back(), HasSubstr("times are those in the names, in ns"));
        EXPECT_EQ(frames.next()->time_ns, 1403636579763555584);
        EXPECT_EQ(frames.next()->time_ns, 1403636579813555584);
    }
    write_image(folder / "cam1/1403636579763555584.png", 1);
    EXPECT_THAT(message_of([&] { ImageFrames({folder.path()}); }), HasSubstr("several cameras: cam0, cam1"));
}

TEST(ImageFrames, SecondsAsNames_AreTimesInTheirOrder) {
    const TemporaryFolder folder;
    write_image(folder / "1305031102.5.png", 2);
    write_image(folder / "1305031102.25.png", 1);
    ImageFrames frames({folder.path()});
    EXPECT_EQ(frames.next()->time_ns, 1305031102250000000);
    EXPECT_EQ(frames.next()->time_ns, 1305031102500000000);
}

TEST(ImageFrames, NamesThatCouldBeTimes_AreAskedBack) {
    const TemporaryFolder folder;
    write_image(folder / "1403636579763.png", 1);
    write_image(folder / "1403636579813.png", 2);
    ImageFrames frames({folder.path()});
    EXPECT_FALSE(frames.is_one_timed_series());
    EXPECT_THAT(frames.notes(), ElementsAre(HasSubstr("--name-times ms or us")));
    ImageFrames in_ms({folder.path()}, {.name_times = NameTimes::ms});
    EXPECT_EQ(in_ms.next()->time_ns, 1403636579763000000);
    write_image(folder / "other.png", 2);
    EXPECT_THAT(message_of([&] { ImageFrames({folder.path()}, {.name_times = NameTimes::ms}); }),
                HasSubstr("other.png: --name-times ms"));
}

TEST(ImageFrames, OneNameThatIsNoTime_LeavesAllWithoutTimes) {
    const TemporaryFolder folder;
    for (const char* name : {"1403636579763555584", "1403636579813555584", "calibration"})
        write_image(folder / fmt::format("{}.png", name), 1);
    ImageFrames frames({folder.path()});
    EXPECT_FALSE(frames.is_one_timed_series());
    EXPECT_THAT(frames.notes(), ElementsAre(HasSubstr("but calibration.png does not: none are taken")));
}

TEST(ImageFrames, InputsWithoutImages_AreRefusedInOneLine) {
    const TemporaryFolder folder;
    const auto complaint = [&](const fs::path& input) {
        return message_of([&] { ImageFrames({folder / input}); });
    };
    fs::create_directory(folder / "empty");
    EXPECT_THAT(complaint("empty"), AllOf(HasSubstr("empty: holds no image"), HasSubstr(".png")));
    EXPECT_THAT(complaint("none"), HasSubstr("none: there is no such file or folder"));
    folder.write("text/notes.txt", "text");
    EXPECT_THAT(complaint("text"), HasSubstr("but: notes.txt"));
    folder.write("films/a.mkv", "");
    EXPECT_THAT(complaint("films"), HasSubstr("but videos: a.mkv"));
    write_image(folder / "sets/left/a.png", 1);
    write_image(folder / "sets/right/a.png", 1);
    EXPECT_THAT(complaint("sets"), HasSubstr("but folders that do: left, right"));
    folder.write("own/recording.yaml", "");
    EXPECT_THAT(complaint("own"), HasSubstr("the recording has no frames"));
    for (const char* name : {"empty", "none", "text", "films", "sets", "own"})
        EXPECT_THAT(complaint(name), Not(HasSubstr("\n")));
}

TEST(ImageFrames, OrientationAndFurtherPictures_AreSaid) {
    const TemporaryFolder folder;
    const cv::Mat image(24, 32, CV_8UC1, cv::Scalar(9));
    const std::vector<unsigned char> jpeg = vision::encode_jpeg(image, 90);
    std::string turned(jpeg.begin(), jpeg.begin() + 2);
    turned += std::string(
        "\xff\xe1\x00\x22"
        "Exif\0\0"
        "MM\0*\0\0\0\x08"
        "\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0"
        "\0\0\0\0",
        36);
    turned.append(jpeg.begin() + 2, jpeg.end());
    folder.write("a.jpg", turned);
    ImageFrames frames({folder / "a.jpg"});
    auto frame = frames.next();
    ASSERT_TRUE(load(*frame));
    EXPECT_EQ(frame->orientation, 6);
    EXPECT_EQ(frame->decoded.size(), image.size()) << "not turned";
    ImageTally tally({});
    tally.add(*frame);
    EXPECT_THAT(tally.notes(), ElementsAre(HasSubstr("1 of 1 images have an orientation tag")));
}

/// An index of which some files are not there, and some are damaged.
Outcome judged_index(std::mt19937_64& random) {
    const TemporaryFolder folder;
    std::string index = "#timestamp [ns],filename\n";
    const std::vector<unsigned char> png = vision::encode_png(cv::Mat(16, 16, CV_8UC1, cv::Scalar(1)), 1);
    const int count = 2 + static_cast<int>(random() % 12);
    std::vector<TimeNs> there;
    std::size_t missing = 0, damaged = 0;
    folder.write("cam0/data/none.txt", "");
    for (int k = 0; k < count; ++k) {
        index += fmt::format("{},{}.png\n", 1000 + 10 * k, k);
        const auto fate = k == 0 ? 9 : random() % 10;
        std::string bytes(png.begin(), png.end());
        if (fate < 3) {
            ++missing;
            continue;
        }
        if (fate < 5) {
            bytes.resize(random() % bytes.size());
            ++damaged;
        } else {
            there.push_back(1000 + 10 * k);
        }
        folder.write(fmt::format("cam0/data/{}.png", k), bytes);
    }
    folder.write("cam0/data.csv", index);
    ImageFrames frames({folder.path()});
    ImageTally tally(frames.missing());
    std::vector<TimeNs> read;
    while (auto frame = frames.next()) {
        if (load(*frame)) read.push_back(*frame->time_ns);
        tally.add(*frame);
    }
    if (read != there) return Outcome::wrong("other frames than those that are there");
    const std::string text = tally.text();
    const auto says = [&](std::size_t number, const char* what) {
        return number == 0 ? text.find(what) == std::string::npos
                           : text.find(fmt::format("; {} {}: ", number, what)) != std::string::npos;
    };
    const bool right = says(missing, "listed and not there") && says(damaged, "damaged") &&
                       tally.all() == static_cast<std::size_t>(count);
    return right ? Outcome::right() : Outcome::wrong(text);
}

TEST(IndexVariations, FramesThatAreMissingOrDamaged_AreLeftOutCountedAndNamed) {
    expect_right_or_refused("index with frames that are missing or damaged", 200, judged_index);
}

}  // namespace
}  // namespace fidservo
