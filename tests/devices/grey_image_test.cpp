// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel formats against values worked out by hand and against OpenCV's own conversions.
#include "vision/v4l2/grey_image.h"

#include "core/failure.h"
#include "core/result.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision::v4l2 {
namespace {

using ::testing::HasSubstr;

std::span<const std::byte> bytes_of(const cv::Mat& image) {
    return {reinterpret_cast<const std::byte*>(image.data),
            image.step[0] * static_cast<std::size_t>(image.rows)};
}

CaptureFormat format_of(PixelFormat pixels, const cv::Mat& image) {
    return {pixels, image.cols, image.rows, image.step[0],
            image.step[0] * static_cast<std::size_t>(image.rows)};
}

cv::Mat grey_of(PixelFormat pixels, const cv::Mat& image) {
    JpegDecoder jpeg;
    return grey_image(format_of(pixels, image), bytes_of(image), jpeg).value();
}

cv::Mat random_image(int rows, int cols, int type) {
    constexpr std::uint64_t seed = 20;
    ::testing::Test::RecordProperty("seed", static_cast<int>(seed));
    cv::Mat image(rows, cols, type);
    cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, 65536);
    return image;
}

double largest_difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_INF);
}

TEST(GreyImage, Grey_IsAViewOnTheBytes) {
    const cv::Mat padded = random_image(5, 16, CV_8UC1);
    const CaptureFormat format{PixelFormat::grey, 11, 5, 16, 80};
    JpegDecoder jpeg;
    const cv::Mat grey = grey_image(format, bytes_of(padded), jpeg).value();
    EXPECT_EQ(grey.data, padded.data);
    EXPECT_EQ(largest_difference(grey, padded.colRange(0, 11)), 0.0) << "rows are 16 bytes apart";
}

TEST(GreyImage, SixteenBit_FullScaleToFullScale) {
    const cv::Mat deep = (cv::Mat_<std::uint16_t>(1, 6) << 0, 128, 129, 257, 25700, 65535);
    const cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 6) << 0, 0, 1, 1, 100, 255);  // nearest to v / 257
    EXPECT_EQ(largest_difference(grey_of(PixelFormat::y16, deep), expected), 0.0);
}

TEST(GreyImage, TwelveAndTenBit_FullScaleToFullScale) {
    const cv::Mat twelve = (cv::Mat_<std::uint16_t>(1, 4) << 0, 8, 2048, 4095);
    const cv::Mat of_twelve =
        (cv::Mat_<std::uint8_t>(1, 4) << 0, 0, 128, 255);  // 255/4095: 0, 0.498, 127.53, 255
    EXPECT_EQ(largest_difference(grey_of(PixelFormat::y12, twelve), of_twelve), 0.0);
    const cv::Mat ten = (cv::Mat_<std::uint16_t>(1, 4) << 0, 2, 3, 1023);
    const cv::Mat of_ten = (cv::Mat_<std::uint8_t>(1, 4) << 0, 0, 1, 255);  // 255/1023: 0, 0.4985, 0.748, 255
    EXPECT_EQ(largest_difference(grey_of(PixelFormat::y10, ten), of_ten), 0.0);
}

TEST(GreyImage, SixteenBit_BytesAreLittleEndian) {
    const std::vector<std::uint8_t> bytes{0x00, 0xff, 0xff, 0x00};
    const CaptureFormat format{PixelFormat::y16, 2, 1, 4, 4};
    JpegDecoder jpeg;
    const cv::Mat grey = grey_image(format, std::as_bytes(std::span(bytes)), jpeg).value();
    EXPECT_EQ(grey.at<std::uint8_t>(0, 0), 254);  // 0xff00 / 257 = 254.008
    EXPECT_EQ(grey.at<std::uint8_t>(0, 1), 1);    // 0x00ff / 257 = 0.992
}

TEST(GreyImage, Yuyv_IsOpenCvsLuma) {
    const cv::Mat yuyv = random_image(24, 32, CV_8UC2);
    cv::Mat expected;
    cv::cvtColor(yuyv, expected, cv::COLOR_YUV2GRAY_YUYV);
    EXPECT_EQ(largest_difference(grey_of(PixelFormat::yuyv, yuyv), expected), 0.0);
    EXPECT_EQ(expected.at<std::uint8_t>(3, 5), yuyv.ptr<std::uint8_t>(3)[10]);
}

class GreyImageOfJpeg : public ::testing::Test {
  protected:
    GreyImageOfJpeg() {
        cv::Mat colour(48, 64, CV_8UC3);
        for (int v = 0; v < colour.rows; ++v)
            for (int u = 0; u < colour.cols; ++u)
                colour.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(4 * u),
                                              static_cast<std::uint8_t>(5 * v),
                                              static_cast<std::uint8_t>(2 * (u + v))};
        cv::imencode(".jpg", colour, jpeg_);
        expected_ = cv::imdecode(jpeg_, cv::IMREAD_GRAYSCALE);
    }

    Result<cv::Mat> decode(const std::vector<std::uint8_t>& bytes) {
        return grey_image({PixelFormat::mjpeg, 64, 48, 0, 10'000}, std::as_bytes(std::span(bytes)), decoder_);
    }

    std::vector<std::uint8_t> jpeg_;
    cv::Mat expected_;
    JpegDecoder decoder_;
};

TEST_F(GreyImageOfJpeg, Whole_IsOpenCvsGrey) {
    EXPECT_EQ(largest_difference(decode(jpeg_).value(), expected_), 0.0);
}

TEST_F(GreyImageOfJpeg, PaddedWithZeros_IsTheSame) {
    jpeg_.resize(jpeg_.size() + 500);
    EXPECT_EQ(largest_difference(decode(jpeg_).value(), expected_), 0.0);
}

TEST_F(GreyImageOfJpeg, WithoutHuffmanTables_HasTheStandards) {
    std::vector<std::uint8_t> without(jpeg_.begin(), jpeg_.begin() + 2);
    std::size_t at = 2;
    for (bool data = false; !data;) {
        const std::size_t length = 2U + jpeg_[at + 2] * 256U + jpeg_[at + 3];
        data = jpeg_[at + 1] == 0xda;
        if (jpeg_[at + 1] != 0xc4)
            without.insert(without.end(), jpeg_.begin() + static_cast<std::ptrdiff_t>(at),
                           jpeg_.begin() + static_cast<std::ptrdiff_t>(at + length));
        at += length;
    }
    without.insert(without.end(), jpeg_.begin() + static_cast<std::ptrdiff_t>(at), jpeg_.end());
    ASSERT_LT(without.size(), jpeg_.size());
    EXPECT_EQ(largest_difference(decode(without).value(), expected_), 0.0);
}

TEST_F(GreyImageOfJpeg, CutShort_IsDamaged) {
    for (const double share : {0.01, 0.5, 0.9}) {
        auto cut = jpeg_;
        cut.resize(static_cast<std::size_t>(share * static_cast<double>(cut.size())));
        const auto image = decode(cut);
        ASSERT_FALSE(image) << share;
        EXPECT_EQ(image.error().reason, Reason::device);
        EXPECT_THAT(image.error().text, HasSubstr("damaged JPEG"));
        EXPECT_TRUE(decode(jpeg_)) << "the frame after it is sound: " << share;
    }
}

TEST(IsWhole, LastRowMayLackItsPadding) {
    const CaptureFormat grey{PixelFormat::grey, 10, 4, 16, 64};
    EXPECT_TRUE(is_whole(grey, 64));
    EXPECT_TRUE(is_whole(grey, 58));
    EXPECT_FALSE(is_whole(grey, 57));
    const CaptureFormat mjpeg{PixelFormat::mjpeg, 10, 4, 0, 64};
    EXPECT_TRUE(is_whole(mjpeg, 1));
    EXPECT_FALSE(is_whole(mjpeg, 0));
}

TEST(PixelFormats, NamesAndCodes_LeadBack) {
    for (const PixelFormat pixels : pixel_formats) {
        EXPECT_EQ(pixel_format_named(name_of(pixels)), pixels);
        EXPECT_EQ(pixel_format_of(fourcc_of(pixels)), pixels);
    }
    EXPECT_EQ(pixel_format_named("grey"), std::nullopt);
    EXPECT_EQ(fourcc_text(fourcc_of(PixelFormat::y16)), "Y16");
    EXPECT_EQ(fourcc_text(fourcc_of(PixelFormat::y16) | 1U << 31U), "Y16 -BE");
}

}  // namespace
}  // namespace fidservo::vision::v4l2
