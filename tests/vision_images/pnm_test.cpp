// SPDX-License-Identifier: GPL-3.0-or-later
// Every format of netpbm, written here from the manual pages, is read with its whole range; what these do not
// allow is refused in words that name it.
#include "tests/src/temporary_folder.h"
#include "vision/images/image_file.h"

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

using fidservo::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int width = 11, height = 7;

/// Of a pixel, 0 black to `largest`, with every level somewhere.
int level_at(int row, int column, int largest) {
    return static_cast<int>(
        std::lround(static_cast<double>(row * width + column) * largest / (width * height - 1)));
}

std::string sample_bytes(int value, int largest) {
    if (largest < 256) return {static_cast<char>(value)};
    return {static_cast<char>(value >> 8), static_cast<char>(value & 0xff)};
}

/// The samples of all pixels, each `colours` times and with so many others behind them.
std::string samples(int largest, int colours, int others, bool as_text) {
    std::string all;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            for (int k = 0; k < colours + others; ++k) {
                const int value = k < colours ? level_at(row, column, largest) : largest / 3;
                all += as_text ? fmt::format("{}{}", all.empty() ? "" : " ", value)
                               : sample_bytes(value, largest);
            }
    return all;
}

std::string pam(int depth, int largest, const std::string& type, const std::string& pixels) {
    return fmt::format("P7\nWIDTH {}\nHEIGHT {}\n# a comment\nDEPTH {}\nMAXVAL {}\n{}ENDHDR\n", width, height,
                       depth, largest, type.empty() ? "" : "TUPLTYPE " + type + "\n") +
           pixels;
}

class Pnm : public ::testing::Test {
  protected:
    TemporaryFolder folder;

    Result<StoredImage> read(const std::string& bytes) const {
        return read_stored(folder.write("a.pnm", bytes));
    }

    std::string complaint(const std::string& bytes) const {
        const auto image = read(bytes);
        return image ? "nothing is wrong" : image.error().text;
    }

    void expect_levels(const std::string& bytes, int largest, const std::string& what) const {
        const auto image = read(bytes);
        ASSERT_TRUE(image) << what << ": " << image.error().text;
        ASSERT_EQ(image->grey.size(), cv::Size(width, height)) << what;
        const cv::Mat grey = to_8_bits(*image, bits_of(*image));
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                EXPECT_NEAR(grey.at<unsigned char>(row, column),
                            255.0 * level_at(row, column, largest) / largest, 1.0)
                    << what;
        EXPECT_EQ(image->has_more_pictures, false) << what;
        EXPECT_EQ(grey.at<unsigned char>(height - 1, width - 1), 255) << what;
        EXPECT_EQ(image->stated_bits,
                  largest > 255 && largest < 65535 ? std::bit_width(unsigned(largest)) : 0)
            << what;
    }
};

TEST_F(Pnm, EveryLargestSampleAndTupleType_IsReadWithItsWholeRange) {
    for (const int largest : {1, 2, 15, 100, 254, 255, 256, 1000, 1023, 4095, 65535}) {
        const std::string size = fmt::format("{} {}\n{}\n", width, height, largest);
        expect_levels("P2 # text\n" + size + samples(largest, 1, 0, true), largest, "P2");
        expect_levels("P3\n" + size + samples(largest, 3, 0, true), largest, "P3");
        expect_levels("P5\n# bytes\n" + size + samples(largest, 1, 0, false), largest, "P5");
        expect_levels("P6\n" + size + samples(largest, 3, 0, false), largest, "P6");
        for (const auto& [type, colours] : {std::pair{"GRAYSCALE", 1},
                                            {"GRAYSCALE_ALPHA", 1},
                                            {"RGB", 3},
                                            {"RGB_ALPHA", 3},
                                            {"", 1},
                                            {"", 3}}) {
            const int others = std::string(type).ends_with("_ALPHA") ? 1 : 0;
            expect_levels(pam(colours + others, largest, type, samples(largest, colours, others, false)),
                          largest, fmt::format("{} {} {}", type, colours, largest));
        }
        expect_levels(pam(6, largest, "RGB_ALPHA", samples(largest, 3, 3, false)), largest, "further planes");
    }
    expect_levels(pam(1, 1, "BLACKANDWHITE", samples(1, 1, 0, false)), 1, "BLACKANDWHITE");
    expect_levels(pam(2, 1, "BLACKANDWHITE_ALPHA", samples(1, 1, 1, false)), 1, "BLACKANDWHITE_ALPHA");
}

TEST_F(Pnm, BitmapOfTextAndOfBits_HasOneForBlack) {
    std::string text = fmt::format("P1\n{} {}\n", width, height),
                bits = fmt::format("P4\n{} {}\n", width, height);
    for (int row = 0; row < height; ++row) {
        unsigned packed = 0;
        for (int column = 0; column < 16; ++column) {
            const bool black = column < width && level_at(row, column, 1) == 0;
            if (column < width) text += black ? '1' : '0';
            packed = packed << 1U | (black ? 1U : 0U);
        }
        bits += sample_bytes(static_cast<int>(packed), 65535);
    }
    expect_levels(text, 1, "P1");
    expect_levels(bits, 1, "P4");
}

TEST_F(Pnm, ColoursBecomeLuma) {
    const auto image = read(std::string("P6 1 1 255\n\xc8\x64\x32", 14));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->grey.at<unsigned char>(0, 0), std::lround(0.299 * 200 + 0.587 * 100 + 0.114 * 50));
}

TEST_F(Pnm, FurtherPictureBehindTheFirst_IsTold) {
    const std::string one = fmt::format("P5 {} {} 255\n", width, height) + samples(255, 1, 0, false);
    const auto image = read(one + one);
    ASSERT_TRUE(image);
    EXPECT_TRUE(image->has_more_pictures);
}

TEST_F(Pnm, WhatNetpbmDoesNotAllow_IsRefusedByName) {
    const std::string grey = samples(255, 1, 0, false);
    EXPECT_THAT(complaint(pam(1, 255, "DISPARITY", grey)),
                AllOf(HasSubstr("TUPLTYPE DISPARITY"), HasSubstr("BLACKANDWHITE, GRAYSCALE or RGB")));
    EXPECT_THAT(complaint(pam(1, 255, "GRAYSCALE_ALPHA", grey)), HasSubstr("DEPTH 1: it must be 2 at least"));
    EXPECT_THAT(complaint(pam(1, 255, "BLACKANDWHITE", grey)), HasSubstr("MAXVAL 255: it must be 1"));
    EXPECT_THAT(complaint(pam(2, 255, "", grey + grey)), HasSubstr("DEPTH 2 without a TUPLTYPE"));
    EXPECT_THAT(complaint(pam(1, 65536, "GRAYSCALE", grey)), HasSubstr("must be 1 to 65535"));
    EXPECT_THAT(complaint(pam(1, 0, "GRAYSCALE", grey)), HasSubstr("must be 1 to 65535"));
    EXPECT_THAT(complaint("P7\nWIDTH 5\nENDHDR\n"), HasSubstr("it has no HEIGHT"));
    EXPECT_THAT(complaint("P7\nWIDTH 5\nWIDTH 6\nENDHDR\n"), HasSubstr("WIDTH stands in it twice"));
    EXPECT_THAT(complaint("P7\nGAMMA 2\nENDHDR\n"), HasSubstr("a line GAMMA"));
    EXPECT_THAT(complaint("P7 332\n"), HasSubstr("first line is not P7 alone"));
    EXPECT_THAT(complaint("P5 20000 1 255\n"), HasSubstr("sides of at most 16383"));
    EXPECT_THAT(complaint("P5 2 1 100\n\x01\x70"), HasSubstr("a sample of 112, above the largest of 100"));
    EXPECT_THAT(complaint("P2 2 1 100\n1 101"), HasSubstr("a sample of 101, above the largest of 100"));
    EXPECT_THAT(complaint("P5 2 1 255\r\n\x01\x70"), HasSubstr("ends in CR LF"));
    EXPECT_THAT(complaint("P5 2 2 255\n\x01\x70"), HasSubstr("cut short: 13 bytes where its header says 15"));
    EXPECT_THAT(complaint("P5 1 1 255\n\x01\x70"), HasSubstr("13 bytes where its header says 12"));
    EXPECT_THAT(complaint("P2 2 2 255\n1 2 3"), HasSubstr("row 1"));
    EXPECT_THAT(complaint("P5 2 x 255\n1 2 3"), HasSubstr("as whole numbers"));
}

TEST_F(Pnm, TextWithoutAnEndOfLine_IsWhole) {
    EXPECT_TRUE(read("P2 2 1 255\n1 20"));
    EXPECT_TRUE(read("P1 2 1 10"));
    EXPECT_TRUE(read("P3 1 1 255 1 2 3"));
}

}  // namespace
}  // namespace fidservo::vision
