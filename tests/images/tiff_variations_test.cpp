// SPDX-License-Identifier: GPL-3.0-or-later
// Pages of TIFFs of every layout, judged by the samples that were written.
#include "src/images/image_frames.h"
#include "tests/images/written_tiff.h"
#include "tests/src/temporary_folder.h"
#include "tests/variations.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <tiffio.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::TiffPage;

template <class T, std::size_t n>
T one_of(std::mt19937_64& random, const T (&choices)[n]) {
    return choices[random() % n];
}

TiffPage drawn_page(std::mt19937_64& random) {
    constexpr int depths[] = {1, 4, 8, 8, 9, 10, 12, 14, 16, 16};
    constexpr int compressions[] = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                                    COMPRESSION_PACKBITS};
    TiffPage page;
    page.bits = one_of(random, depths);
    page.compression = one_of(random, compressions);
    page.photometric = static_cast<int>(random() % (page.bits <= 8 ? 4 : 3));
    const bool colour = page.photometric == PHOTOMETRIC_RGB;
    page.is_planar = colour && random() % 2 == 0;
    page.is_tiled = random() % 2 == 0;
    page.rows_per_strip = 1 + static_cast<int>(random() % 20);
    page.orientation = 1 + static_cast<int>(random() % 8);
    const cv::Size size(8 + static_cast<int>(random() % 70), 8 + static_cast<int>(random() % 50));
    page.samples.create(size, colour ? CV_16UC3 : CV_16UC1);
    cv::RNG noise(random());
    noise.fill(page.samples, cv::RNG::UNIFORM, 0, 1 << page.bits);
    page.samples.at<std::uint16_t>(0, 0) = static_cast<std::uint16_t>((1 << page.bits) - 1);
    return page;
}

/// The largest difference between a frame and what was written, in grey levels of 255.
double worst_difference(const TiffPage& page, const cv::Mat& frame, int bits) {
    double worst = 0.0;
    for (int row = 0; row < frame.rows; ++row)
        for (int column = 0; column < frame.cols; ++column) {
            const auto* sample = page.samples.ptr<std::uint16_t>(row) + column * page.samples.channels();
            const double value = page.samples.channels() == 3
                                     ? 0.299 * sample[0] + 0.587 * sample[1] + 0.114 * sample[2]
                                     : sample[0];
            const int own_bits = page.bits > 8 ? bits : page.bits;
            double grey = 255.0 * std::min(1.0, value / ((1 << own_bits) - 1));
            if (page.photometric == PHOTOMETRIC_MINISWHITE || page.photometric == PHOTOMETRIC_PALETTE)
                grey = 255.0 - grey;
            worst = std::max(worst, std::abs(grey - frame.at<unsigned char>(row, column)));
        }
    return worst;
}

Outcome judged_stack(std::mt19937_64& random) {
    const TemporaryFolder folder;
    std::vector<TiffPage> pages, frames;
    const int count = 1 + static_cast<int>(random() % 5);
    int bits = 8;
    for (int k = 0; k < count; ++k) {
        pages.push_back(drawn_page(random));
        frames.push_back(pages.back());
        if (pages.back().bits > 8) bits = std::max(bits, pages.back().bits);
        if (random() % 4 == 0) {
            pages.push_back(drawn_page(random));
            pages.back().is_reduced = true;
        }
    }
    const std::string mode =
        std::string("w") + (random() % 2 == 0 ? "l" : "b") + (random() % 2 == 0 ? "8" : "");
    write_tiff(folder / "stack.tif", mode, pages);
    ImageFrames sequence({folder / "stack.tif"});
    constexpr double rounding = 1.01;  // of colours of fewer than 8 bits, once more for luma
    for (std::size_t k = 0; k < frames.size(); ++k) {
        auto frame = sequence.next();
        if (!frame) return Outcome::wrong(fmt::format("{} of {} pages", k, frames.size()));
        if (!load(*frame)) return Outcome::wrong(frame->damage);
        if (frame->orientation != frames[k].orientation) return Outcome::wrong("orientation");
        if (frame->decoded.size() != frames[k].samples.size()) return Outcome::wrong("size");
        if (const double worst = worst_difference(frames[k], frame->decoded, bits); worst > rounding)
            return Outcome::wrong(fmt::format("page {} of {} bits, photometric {}: by {}", k, frames[k].bits,
                                              frames[k].photometric, worst));
    }
    return sequence.next() ? Outcome::wrong("more frames than pages") : Outcome::right();
}

TEST(TiffVariations, PagesOfEveryLayout_AreAllRead) {
    expect_right_or_refused("pages of a TIFF: bits, compression, tiles, byte order, BigTIFF", 200,
                            judged_stack);
}

TEST(Tiff, ReducedCopyOfAPictureElsewhere_IsNotTakenForIt) {
    const TemporaryFolder folder;
    std::vector<TiffPage> pages(2);
    for (TiffPage& page : pages) page.samples = cv::Mat(20, 20, CV_16UC1, cv::Scalar(9));
    pages[0].is_reduced = true;
    pages[0].has_subdirectory = true;
    write_tiff(folder / "raw.dng", "w", pages);
    ImageFrames frames({folder.path()});
    ASSERT_EQ(frames.size(), 1U);
    auto frame = frames.next();
    EXPECT_FALSE(load(*frame));
    EXPECT_THAT(frame->damage, HasSubstr("raw.dng: only a reduced copy of its picture is a page"));
}

TEST(Tiff, JpegInside_IsRead) {
    const TemporaryFolder folder;
    for (const int photometric : {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_YCBCR}) {
        TiffPage page;
        page.compression = COMPRESSION_JPEG;
        page.photometric = photometric;
        page.rows_per_strip = 16;
        page.samples.create(48, 64, photometric == PHOTOMETRIC_YCBCR ? CV_16UC3 : CV_16UC1);
        page.samples.setTo(cv::Scalar(200, 100, 50));
        testing::write_tiff(folder / "a.tif", "w", {page});
        const double grey = photometric == PHOTOMETRIC_YCBCR ? 0.299 * 200 + 0.587 * 100 + 0.114 * 50 : 200.0;
        ImageFrames frames({folder / "a.tif"});
        auto frame = frames.next();
        ASSERT_TRUE(load(*frame)) << frame->damage;
        EXPECT_NEAR(cv::mean(frame->decoded)[0], grey, 2.0);
    }
}

TEST(Tiff, PageThatIsDamaged_IsLeftOutAndNamed) {
    const TemporaryFolder folder;
    std::mt19937_64 random(3);
    std::vector<TiffPage> pages(3);
    for (TiffPage& page : pages) {
        page.samples.create(40, 40, CV_16UC1);
        page.samples.setTo(100);
        page.rows_per_strip = 40;
        page.compression = COMPRESSION_ADOBE_DEFLATE;
    }
    write_tiff(folder / "stack.tif", "w", pages);
    // The first page's strip lies behind the header; its compressed data begin there.
    std::string bytes = testing::text_of(folder / "stack.tif");
    for (std::size_t at = 8; at < 24; ++at) bytes[at] = '\xff';
    folder.write("stack.tif", bytes);
    ImageFrames frames({folder / "stack.tif"});
    ASSERT_EQ(frames.size(), 3U);
    auto first = frames.next(), second = frames.next();
    EXPECT_FALSE(load(*first));
    EXPECT_THAT(first->damage, HasSubstr("stack.tif: cannot be read as an image: damaged TIFF"));
    EXPECT_TRUE(load(*second));
    EXPECT_THAT(second->name, HasSubstr("stack.tif#1"));
}

TEST(Tiff, ListOfPagesThatIsBrokenOff_IsADamagedFrame) {
    const TemporaryFolder folder;
    std::vector<TiffPage> pages(4);
    for (TiffPage& page : pages) page.samples = cv::Mat(20, 20, CV_16UC1, cv::Scalar(9));
    write_tiff(folder / "stack.tif", "w", pages);
    const std::string bytes = testing::text_of(folder / "stack.tif");
    folder.write("stack.tif", bytes.substr(0, bytes.size() * 6 / 10));
    ImageFrames frames({folder / "stack.tif"});
    std::size_t read = 0, damaged = 0;
    while (auto frame = frames.next()) ++(load(*frame) ? read : damaged);
    EXPECT_EQ(read, 2U);
    EXPECT_EQ(damaged, 1U);
}

TEST(Tiff, ThousandPages_AreAThousandFrames) {
    const TemporaryFolder folder;
    std::vector<TiffPage> pages(1000);
    for (TiffPage& page : pages) page.samples = cv::Mat(8, 8, CV_16UC1, cv::Scalar(9));
    pages[700].samples.setTo(77);
    write_tiff(folder / "stack.tif", "w", pages);
    ImageFrames frames({folder / "stack.tif"});
    ASSERT_EQ(frames.size(), 1000U);
    for (int k = 0; k < 700; ++k) frames.next();
    auto frame = frames.next();
    ASSERT_TRUE(load(*frame));
    EXPECT_EQ(frame->decoded.at<unsigned char>(3, 3), 77);
}

TEST(Tiff, HugeClaimInASmallFile_IsRefusedInOneLine) {
    const TemporaryFolder folder;
    for (const std::uint32_t side : {60000U, 16000U}) {
        TIFF* tiff = TIFFOpen((folder / "bomb.tif").c_str(), "w");
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
        std::vector<unsigned char> row(side, 7);
        TIFFWriteScanline(tiff, row.data(), 0, 0);
        TIFFClose(tiff);
        ImageFrames frames({folder / "bomb.tif"});
        auto frame = frames.next();
        ASSERT_TRUE(frame);
        EXPECT_FALSE(load(*frame));
        EXPECT_THAT(frame->damage, HasSubstr(fmt::format("{0} x {0} px", side)));
    }
}

}  // namespace
}  // namespace fidservo
