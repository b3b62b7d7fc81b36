// SPDX-License-Identifier: GPL-3.0-or-later
// Images are read as OpenCV's own codecs read them, and what is written is read back.
#include "vision/images/image_file.h"

#include "tests/src/temporary_folder.h"

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::vision {
namespace {

using ::testing::HasSubstr;

/// Smooth with noise on it, so that codecs have something to do.
cv::Mat picture(int type, unsigned seed) {
    cv::Mat image(37, 53, type);
    cv::RNG random(seed);
    random.fill(image, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_16U ? 65536 : 256);
    cv::Mat smooth(image.size(), type);
    for (int row = 0; row < image.rows; ++row)
        smooth.row(row).setTo(cv::Scalar::all(row * (CV_MAT_DEPTH(type) == CV_16U ? 1500 : 6)));
    cv::addWeighted(image, 0.2, smooth, 0.8, 0.0, image);
    return image;
}

class ImageFile : public ::testing::Test {
  protected:
    fidservo::testing::TemporaryFolder folder;

    void write(const std::string& name, const std::vector<unsigned char>& bytes) const {
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    }

    /// The largest difference from what OpenCV makes of the same file.
    double difference_from_opencv(const std::string& name) const {
        const cv::Mat expected =
            cv::imread((folder / name).string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
        const auto read = read_grey(folder / name);
        if (!read) throw std::runtime_error(read.error().text);
        EXPECT_EQ(read->type(), CV_8UC1);
        if (read->size() != expected.size()) throw std::runtime_error(name + ": of another size");
        return cv::norm(*read, expected, cv::NORM_INF);
    }

    std::string complaint(const std::string& name) const {
        const auto read = read_grey(folder / name);
        return read ? "nothing is wrong" : read.error().text;
    }
};

TEST_F(ImageFile, EveryDepthAndFormat_IsReadAsByOpenCv) {
    constexpr int types[] = {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4};
    for (const int type : types) {
        const cv::Mat image = picture(type, static_cast<unsigned>(type) + 1);
        for (const std::string ending : {"png", "tiff"}) {
            const std::string name = "type" + std::to_string(type) + "." + ending;
            ASSERT_TRUE(cv::imwrite((folder / name).string(), image)) << name;
            // OpenCV drops the lower eight of 16 bits, and rounds a TIFF's colours otherwise.
            const bool as_exact = type == CV_8UC1 || (CV_MAT_DEPTH(type) == CV_8U && ending == "png");
            const double rounding = as_exact ? 0.0 : 1.0;
            EXPECT_LE(difference_from_opencv(name), rounding) << name;
        }
    }
    for (const std::string name : {"a.jpg", "a.pgm", "a.bmp", "a.webp", "a.jp2"}) {
        ASSERT_TRUE(cv::imwrite((folder / name).string(), picture(CV_8UC1, 7))) << name;
        EXPECT_EQ(difference_from_opencv(name), 0.0) << name;
    }
    for (const std::string name : {"b.jpg", "b.ppm", "b.bmp", "b.webp"}) {
        ASSERT_TRUE(cv::imwrite((folder / name).string(), picture(CV_8UC3, 8))) << name;
        EXPECT_EQ(difference_from_opencv(name), 0.0) << name;
    }
}

TEST_F(ImageFile, OneBitPng_IsReadAsByOpenCv) {
    cv::Mat image = picture(CV_8UC1, 3) > 110;
    ASSERT_TRUE(cv::imwrite((folder / "one.png").string(), image, {cv::IMWRITE_PNG_BILEVEL, 1}));
    EXPECT_EQ(difference_from_opencv("one.png"), 0.0);
}

TEST_F(ImageFile, FormatIsToldByContent_NotByTheName) {
    write("a.tiff", encode_png(picture(CV_8UC1, 5), 1));
    EXPECT_EQ(difference_from_opencv("a.tiff"), 0.0);
}

TEST_F(ImageFile, PngThatWasWritten_IsReadBackBitForBit) {
    const cv::Mat image = picture(CV_8UC1, 11);
    for (const int compression : {1, 3, 9}) {
        write("a.png", encode_png(image, compression));
        EXPECT_EQ(cv::norm(*read_grey(folder / "a.png"), image, cv::NORM_INF), 0.0);
        EXPECT_EQ(difference_from_opencv("a.png"), 0.0);
    }
    const cv::Mat part = image(cv::Rect(5, 7, 20, 11));
    write("part.png", encode_png(part, 1));
    EXPECT_EQ(cv::norm(*read_grey(folder / "part.png"), part, cv::NORM_INF), 0.0);
}

TEST_F(ImageFile, JpegThatWasWritten_IsOpenCvsOfThatQuality) {
    const cv::Mat image = picture(CV_8UC1, 13);
    for (const int quality : {72, 95}) {
        write("ours.jpg", encode_jpeg(image, quality));
        cv::imwrite((folder / "theirs.jpg").string(), image, {cv::IMWRITE_JPEG_QUALITY, quality});
        EXPECT_EQ(cv::norm(*read_grey(folder / "ours.jpg"), *read_grey(folder / "theirs.jpg"), cv::NORM_INF),
                  0.0);
    }
}

TEST_F(ImageFile, CutShortAnywhere_IsRefusedByName) {
    const std::vector<unsigned char> png = encode_png(picture(CV_8UC1, 17), 3);
    const std::vector<unsigned char> jpeg = encode_jpeg(picture(CV_8UC1, 17), 80);
    for (const double share : {0.02, 0.3, 0.9, 0.99}) {
        for (const auto& [name, whole] : {std::pair{"cut.png", &png}, std::pair{"cut.jpg", &jpeg}}) {
            const auto kept = static_cast<std::ptrdiff_t>(share * static_cast<double>(whole->size()));
            write(name, {whole->begin(), whole->begin() + kept});
            EXPECT_THAT(complaint(name), HasSubstr(std::string(name) + ": cannot be read as an image"))
                << share;
        }
    }
}

TEST_F(ImageFile, AnyByteOfAPngWrong_IsReadOrRefused_NeverReadWrongly) {
    const cv::Mat image = picture(CV_8UC1, 19);
    const std::vector<unsigned char> png = encode_png(image, 3);
    std::mt19937 random(20261127);
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<unsigned char> damaged = png;
        damaged[random() % damaged.size()] ^= static_cast<unsigned char>(1U << (random() % 8));
        write("damaged.png", damaged);
        const auto read = read_grey(folder / "damaged.png");
        if (!read || read->size() != image.size()) continue;
        EXPECT_EQ(cv::norm(*read, image, cv::NORM_INF), 0.0) << "trial " << trial;
    }
}

TEST_F(ImageFile, NoImage_IsRefusedByName) {
    write("text.png", {'t', 'e', 'x', 't'});
    write("empty.jpg", {});
    for (const std::string name : {"text.png", "empty.jpg", "absent.tiff"})
        EXPECT_THAT(complaint(name), HasSubstr(name + ": cannot be read as an image"));
}

TEST_F(ImageFile, HeaderOfAHugePng_IsRefusedWithoutTheMemory) {
    std::vector<unsigned char> png = encode_png(cv::Mat(4, 4, CV_8UC1, cv::Scalar(9)), 1);
    constexpr std::size_t width_at = 16, height_at = 20;
    for (const std::size_t at : {width_at, height_at})
        png[at + 1] = 0x7f;  // 8 million px each way; its sum is wrong, too
    write("huge.png", png);
    EXPECT_THAT(complaint("huge.png"), HasSubstr("huge.png: cannot be read as an image"));
}

TEST_F(ImageFile, SideThatTheTagLibraryCannotTake_IsRefused) {
    for (const auto& [width, height] : {std::pair{16384, 4}, std::pair{4, 16384}}) {
        write("long.png", encode_png(cv::Mat(height, width, CV_8UC1, cv::Scalar(9)), 1));
        write("long.jpg", encode_jpeg(cv::Mat(height, width, CV_8UC1, cv::Scalar(9)), 90));
        for (const std::string name : {"long.png", "long.jpg"})
            EXPECT_THAT(
                complaint(name),
                HasSubstr(fmt::format("{} x {} px: sides of at most 16383 px are read", width, height)));
    }
}

}  // namespace
}  // namespace fidservo::vision
