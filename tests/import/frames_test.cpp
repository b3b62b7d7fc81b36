// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of a log's images, and of names and folders that a terminal or a disk does not take.
#include "src/files/recording/reader.h"
#include "src/import/assemble.h"
#include "src/import/draft_map.h"
#include "src/import/import_map.h"
#include "src/import/read_log.h"
#include "src/import/recording_folder.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using fidservo::testing::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

void write_camera(const std::filesystem::path& log, const std::string& camera,
                  const std::filesystem::path& out) {
    const std::vector<Log> logs{read_log(log, testing::no_table_options)};
    const ImportMap map = parse_import_map(
        fmt::format("format: fidservo-map/1\nrecording: {{ name: a, rig: b, experiment: c, tick_s: 0.001 }}\n"
                    "camera: {{ images: {} }}\n",
                    camera),
        "map.yaml");
    write_folder(out, assemble(logs, map));
}

/// A row of pixels of 16 bits.
std::string image_of_16_bits(std::int64_t stamp_ns, const std::vector<std::uint16_t>& pixels,
                             const std::string& encoding, bool is_big) {
    std::string bytes;
    for (const std::uint16_t pixel : pixels) {
        const char low = static_cast<char>(pixel & 0xFFU), high = static_cast<char>(pixel >> 8U);
        bytes += is_big ? std::string{high, low} : std::string{low, high};
    }
    return testing::CdrBytes()
        .header(stamp_ns)
        .number(std::uint32_t{1})
        .number(static_cast<std::uint32_t>(pixels.size()))
        .text(encoding)
        .number(static_cast<std::uint8_t>(is_big))
        .number(static_cast<std::uint32_t>(2 * pixels.size()))
        .octets(bytes)
        .bytes();
}

/// The grey levels of a recording's frames, one after the other.
std::vector<int> levels_in(const std::filesystem::path& recording) {
    std::vector<int> levels;
    for (const auto& frame : read_recording(recording).frames) {
        const cv::Mat image =
            cv::imread((recording / "cam0/data" / frame.filename).string(), cv::IMREAD_UNCHANGED);
        EXPECT_EQ(image.type(), CV_8UC1);
        for (const unsigned char level : cv::Mat_<unsigned char>(image)) levels.push_back(level);
    }
    return levels;
}

TEST(ImportedFrames, ImagesOf16BitsOfABag_BecomeGreyByOneRange) {
    const TemporaryFolder folder;
    for (const std::string encoding : {"mono16", "16UC1"})
        for (const bool is_big : {false, true}) {
            const std::string name = fmt::format("{}{}", encoding, is_big);
            testing::make_bag(folder / (name + ".db3"),
                              {{"/img",
                                "sensor_msgs/msg/Image",
                                {{1, image_of_16_bits(1, {0, 819, 1638}, encoding, is_big)},
                                 {2, image_of_16_bits(2, {0, 4095, 803}, encoding, is_big)}}}});
            write_camera(folder / (name + ".db3"), "/img", folder / name);
            EXPECT_THAT(levels_in(folder / name), ElementsAre(0, 51, 102, 0, 255, 50)) << name;
        }
}

void make_euroc_camera(const TemporaryFolder& folder) {
    std::filesystem::create_directories(folder / "mav0/cam0/data");
    std::string index = "#timestamp [ns],filename\n";
    for (const int k : {1, 2}) {
        const cv::Mat image =
            cv::Mat_<std::uint16_t>({1, 2}, {std::uint16_t{0}, std::uint16_t(2048 * k - 1)});
        const std::string name = fmt::format("{}.png", k);
        cv::imwrite((folder / "mav0/cam0/data" / name).string(), image);
        index += fmt::format("{}000000,{}\n", 50 * k, name);
    }
    folder.write("mav0/cam0/data.csv", index);
}

TEST(ImportedFrames, ImagesOf16BitsOfAFolder_BecomeGreyByOneRange) {
    const TemporaryFolder folder;
    make_euroc_camera(folder);
    write_camera(folder.path(), "cam0", folder / "out");
    EXPECT_THAT(levels_in(folder / "out"), ElementsAre(0, 127, 0, 255));
}

TEST(ImportedFrames, ImageOfAFolderThatIsListedAndMissing_IsCountedAndNamed) {
    const TemporaryFolder folder;
    make_euroc_camera(folder);
    std::filesystem::remove(folder / "mav0/cam0/data/1.png");
    EXPECT_THAT(read_log(folder.path(), testing::no_table_options).notes,
                Contains("cam0: 1 of 2 images are listed and not there: 1.png"));
}

TEST(ImportedFrames, DamagedCompressedImage_IsRefusedAndNothingIsLeft) {
    const TemporaryFolder folder;
    std::vector<unsigned char> png, jpeg;
    const cv::Mat grey(40, 60, CV_8UC1, cv::Scalar(90));
    ASSERT_TRUE(cv::imencode(".png", grey, png));
    ASSERT_TRUE(cv::imencode(".jpg", grey, jpeg));
    const std::string whole(png.begin(), png.end()), photo(jpeg.begin(), jpeg.end());
    int number = 0;
    for (const std::string& bytes : {whole.substr(0, whole.size() / 2), std::string("\x89PNGgarbage"),
                                     photo.substr(0, photo.size() / 2)}) {
        const auto message = [](std::int64_t stamp_ns, const std::string& image) {
            return testing::CdrBytes().header(stamp_ns).text("png").octets(image).bytes();
        };
        const auto bag = folder / fmt::format("{}.db3", number++);
        testing::make_bag(
            bag,
            {{"/img", "sensor_msgs/msg/CompressedImage", {{1, message(1, whole)}, {2, message(2, bytes)}}}});
        EXPECT_THAT(message_of([&] { write_camera(bag, "/img", folder / "out"); }),
                    HasSubstr("/img: frame 2: "));
        EXPECT_FALSE(std::filesystem::exists(folder / "out"));
        EXPECT_FALSE(std::filesystem::exists(folder / "out.unfinished"));
    }
}

TEST(ImportedNames, ControlCharactersOfTopics_AreWrittenOutInTheMapAndFoundByIt) {
    const TemporaryFolder folder;
    testing::BagTopic topic{"/x\x1B[2J\nposition\xC2\x9B", "std_msgs/msg/Float64", {}};
    for (int k = 0; k < 3; ++k) topic.messages.emplace_back(1'000'000 * k, testing::float64(k));
    testing::make_bag(folder / "b.db3", {topic, {"/odd\x1B", "a/msg/B", {}}});
    const std::vector<Log> logs{read_log(folder / "b.db3", testing::no_table_options)};
    const std::string draft = draft_map(logs);
    EXPECT_THAT(draft, HasSubstr("position: { signal: '/x\\x1B[2J\\x0Aposition\\x9B', unit: mm }"));
    EXPECT_TRUE(
        std::ranges::none_of(draft, [](char letter) { return letter == '\x1B' || letter == '\x9B'; }));
    EXPECT_EQ(assemble(logs, parse_import_map(draft, "map.yaml")).recording.rows.size(), 3u);
}

TEST(ImportedFolder, NameThatTheDiskDoesNotTake_IsOneLine) {
    const TemporaryFolder folder;
    for (const std::size_t length : {300u, 250u})
        EXPECT_THAT(message_of([&] { write_folder(folder / std::string(length, 'n'), {}); }),
                    HasSubstr("cannot be made: File name too long"));
}

}  // namespace
}  // namespace fidservo::imports
