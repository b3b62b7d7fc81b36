// SPDX-License-Identifier: GPL-3.0-or-later
// Truncated files, and files with one wrong byte. A truncated file is never accepted as complete. A wrong
// byte is detected if the format has a checksum; otherwise the image has at least the right size.
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"
#include "vision/images/image_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

using testing::TemporaryFolder;

struct Format {
    const char* name;
    bool has_checksum;
    int type = -1;  ///< -1: grey or colour
};

constexpr Format formats[] = {{"a.png", true},   {"a.jpg", false},          {"a.tif", false},
                              {"a.bmp", false},  {"a.pgm", false, CV_8UC1}, {"a.ppm", false, CV_8UC3},
                              {"a.webp", false}, {"a.jp2", false}};

Outcome judged_damage(std::mt19937_64& random) {
    const TemporaryFolder folder;
    const Format format = formats[random() % std::size(formats)];
    const int type = random() % 2 == 0 ? CV_8UC1 : CV_8UC3;
    cv::Mat image(64 + static_cast<int>(random() % 40), 64 + static_cast<int>(random() % 40),
                  format.type < 0 ? type : format.type);
    cv::RNG noise(random());
    noise.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::imwrite((folder / format.name).string(), image);
    const auto whole = vision::read_grey(folder / format.name);
    if (!whole) return Outcome::wrong("the whole file: " + whole.error().text);
    std::string bytes = testing::text_of(folder / format.name);
    const bool cut = random() % 2 == 0;
    if (cut)
        bytes.resize(1 + random() % (bytes.size() - 1));
    else  // in the second half, where pixels are
        bytes[bytes.size() / 2 + random() % (bytes.size() / 2)] ^= static_cast<char>(1U << random() % 8);
    folder.write(format.name, bytes);
    const auto read = vision::read_grey(folder / format.name);
    if (!read) return Outcome::refused(read.error().text);
    if (read->size() != whole->size()) return Outcome::wrong(fmt::format("{}: of another size", format.name));
    const bool same = cv::norm(*read, *whole, cv::NORM_INF) == 0.0;
    if (same || (!cut && !format.has_checksum)) return Outcome::right();
    return Outcome::wrong(fmt::format("{}: {}", format.name, cut ? "cut short" : "a wrong byte"));
}

TEST(DamageVariations, FilesCutShortOrWithAWrongByte_AreNeverTakenForWhole) {
    expect_right_or_refused("damage: a file cut short or a wrong byte, by format", 400, judged_damage);
}

/// A compressed image of a single colour is so short that a missing end is easily overlooked.
TEST(Damage, FlatImagesCutShort_AreRefused) {
    const TemporaryFolder folder;
    for (const Format& format : formats) {
        const int type = format.type < 0 ? CV_8UC3 : format.type;
        ASSERT_TRUE(
            cv::imwrite((folder / format.name).string(), cv::Mat(64, 64, type, cv::Scalar(40, 90, 200))));
        const std::string bytes = testing::text_of(folder / format.name);
        for (const double share : {0.5, 0.8, 0.95}) {
            folder.write(
                format.name,
                bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
            EXPECT_FALSE(vision::read_grey(folder / format.name)) << format.name << " " << share;
        }
    }
}

}  // namespace
}  // namespace fidservo
