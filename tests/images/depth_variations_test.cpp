// SPDX-License-Identifier: GPL-3.0-or-later
// Sequences of samples of 8 to 16 bits, dark and bright: one full scale for all of a sequence's frames.
#include "src/images/grey_range.h"
#include "src/images/image_frames.h"
#include "tests/images/written_tiff.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <png.h>

namespace fidservo {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// A PNG of 16 bits with a chunk sBIT.
void write_png_with_sbit(const fs::path& file, const cv::Mat& grey, int stated_bits) {
    std::FILE* stream = std::fopen(file.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, static_cast<png_uint_32>(grey.cols), static_cast<png_uint_32>(grey.rows), 16,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_color_8 significant{};
    significant.gray = static_cast<png_byte>(stated_bits);
    png_set_sBIT(png, info, &significant);
    png_write_info(png, info);
    png_set_swap(png);
    for (int row = 0; row < grey.rows; ++row) png_write_row(png, grey.ptr(row));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(stream);
}

enum class Format { png, stated_png, colour_png, tiff, packed_tiff, pgm, jpeg_2000 };
constexpr int formats = 7;

void write_frame(const fs::path& folder, int number, const cv::Mat& grey, Format format, int bits) {
    const auto name = [&](const char* ending) {
        return (folder / fmt::format("f{}.{}", number, ending)).string();
    };
    switch (format) {
        case Format::png:
            cv::imwrite(name("png"), grey);
            break;
        case Format::stated_png:
            write_png_with_sbit(name("png"), grey, bits);
            break;
        case Format::colour_png: {
            cv::Mat colours;
            cv::merge(std::vector<cv::Mat>{grey, grey, grey, grey}, colours);
            cv::imwrite(name("png"), colours);
            break;
        }
        case Format::tiff:
            testing::write_tiff(name("tif"), "w", {{.samples = grey, .bits = 16}});
            break;
        case Format::packed_tiff:
            testing::write_tiff(name("tif"), "w", {{.samples = grey, .bits = bits}});
            break;
        case Format::pgm:
            cv::imwrite(name("pgm"), grey);
            break;
        case Format::jpeg_2000:
            cv::imwrite(name("jp2"), grey, {cv::IMWRITE_JPEG2000_COMPRESSION_X1000, 1000});
            break;
    }
}

/// Frames of which only one shows what needs all bits.
Outcome judged_sequence(std::mt19937_64& random) {
    const TemporaryFolder folder;
    const int bits = 8 + static_cast<int>(random() % 9);
    const auto format = static_cast<Format>(random() % formats);
    if (format == Format::packed_tiff && bits < 9) return Outcome::right();  // is of 8 bits
    const bool stated = format == Format::stated_png || (format == Format::packed_tiff && bits < 16);
    const int count = 1 + static_cast<int>(random() % 4);
    const int brightest = static_cast<int>(random() % static_cast<unsigned>(count));
    std::vector<cv::Mat> frames;
    for (int k = 0; k < count; ++k) {
        cv::Mat grey(64, 80, CV_16UC1);
        cv::RNG noise(random());
        noise.fill(grey, cv::RNG::UNIFORM, 0, 1 << (bits - 1 - static_cast<int>(random() % 3)));
        if (k == brightest && !stated)
            grey.at<std::uint16_t>(5, 5) =
                static_cast<std::uint16_t>((1 << bits) - 1 - static_cast<int>(random() % 20));
        write_frame(folder.path(), k, grey, format, bits);
        frames.push_back(grey);
    }
    ImageFrames sequence({folder.path()});
    const double scale = 255.0 / ((1 << bits) - 1);
    for (const cv::Mat& grey : frames) {
        auto frame = sequence.next();
        if (!frame || !load(*frame)) return Outcome::wrong(frame ? frame->damage : "too few");
        cv::Mat expected, read;
        grey.convertTo(expected, CV_64F, scale);
        frame->decoded.convertTo(read, CV_64F);
        const double worst = cv::norm(expected, read, cv::NORM_INF);
        const double rounding = format == Format::colour_png ? 1.01 : 0.501;
        if (worst > rounding)
            return Outcome::wrong(
                fmt::format("format {}, {} bits: by {}", static_cast<int>(format), bits, worst));
    }
    return Outcome::right();
}

TEST(DepthVariations, BitsInSixteen_BecomeTheWholeRangeOnceForASequence) {
    expect_right_or_refused("bits of a sample: 8 to 16, by format, dark or bright", 200, judged_sequence);
}

TEST(GreyRange, WhatWasDecided_IsSaid) {
    const TemporaryFolder folder;
    cv::Mat grey(64, 64, CV_16UC1);
    cv::randu(grey, 0, 4096);
    cv::imwrite((folder / "a.png").string(), grey);
    EXPECT_THAT(ImageFrames({folder.path()}).notes(),
                ElementsAre(folder.path().string() + ": 12 of 16 bits are used: 4095 is white"));
}

TEST(GreyRange, HotPixelThatLeavesFewLevels_IsSaid) {
    const TemporaryFolder folder;
    cv::Mat grey(64, 64, CV_16UC1);
    cv::randu(grey, 0, 1024);
    grey.at<std::uint16_t>(9, 9) = 65535;
    cv::imwrite((folder / "a.png").string(), grey);
    EXPECT_THAT(ImageFrames({folder.path()}).notes(),
                ElementsAre(::testing::AllOf(HasSubstr("16 of 16 bits are used"),
                                             HasSubstr("on 5 of 256 grey levels"))));
}

TEST(GreyRange, AllInputsOfACalibration_HaveOne) {
    const TemporaryFolder folder;
    cv::imwrite((folder / "a.png").string(), cv::Mat(8, 8, CV_16UC1, cv::Scalar(1000)));
    cv::imwrite((folder / "b.png").string(), cv::Mat(8, 8, CV_16UC1, cv::Scalar(4000)));
    ImageFrames together({folder / "a.png", folder / "b.png"}, {.one_range = true});
    EXPECT_NEAR(decode(*together.next()).at<unsigned char>(0, 0), 1000.0 * 255.0 / 4095.0, 0.51);
    for (const char* name : {"a", "b"}) {
        fs::create_directory(folder / name);
        fs::copy(folder / (std::string(name) + ".png"), folder / name);
    }
    ImageFrames apart({folder / "a", folder / "b"});
    EXPECT_NEAR(decode(*apart.next()).at<unsigned char>(0, 0), 1000.0 * 255.0 / 1023.0, 0.51);
    ImageFrames folders({folder / "a", folder / "b"}, {.one_range = true});
    EXPECT_NEAR(decode(*folders.next()).at<unsigned char>(0, 0), 1000.0 * 255.0 / 4095.0, 0.51);
}

TEST(GreyRange, FloatingPoint_IsRefusedInOneLine) {
    const TemporaryFolder folder;
    const cv::Mat floats(8, 8, CV_32FC1, cv::Scalar(0.5));
    cv::imwrite((folder / "a.tif").string(), floats);
    cv::imwrite((folder / "b.pfm").string(), floats);
    for (const char* name : {"a.tif", "b.pfm"}) {
        ImageFrames frames({folder / name});
        EXPECT_THAT(testing::message_of([&] { decode(*frames.next()); }), HasSubstr("8 or 16 bits")) << name;
    }
}

}  // namespace
}  // namespace fidservo
