// SPDX-License-Identifier: GPL-3.0-or-later
// TIFFs whose pictures have no directory of their own, and damage that only a checksum shows.
#include "src/images/image_frames.h"
#include "tests/images/written_tiff.h"
#include "tests/src/temporary_folder.h"
#include "vision/images/image_file.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <tiffio.h>

namespace fidservo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;
using testing::TiffPage;

std::vector<TiffPage> pages_of(int count) {
    std::vector<TiffPage> pages(static_cast<std::size_t>(count));
    for (TiffPage& page : pages) {
        page.samples.create(32, 48, CV_16UC1);
        cv::randu(page.samples, 0, 256);
    }
    return pages;
}

std::vector<std::string> notes_of(const std::filesystem::path& file) {
    return ImageFrames({file}).notes();
}

TEST(TiffPages, PicturesThatOnlyADescriptionCounts_AreSaidToBePassedOver) {
    const TemporaryFolder folder;
    const std::pair<const char*, const char*> descriptions[] = {
        {"ImageJ=1.53t\nimages=4\nslices=4\n", "ImageJ's description"},
        {"{\"shape\": [4, 32, 48]}", "tifffile's description"},
        {"{\"truncated\": true, \"shape\": [2, 2, 32, 48]}", "tifffile's description"}};
    for (const auto& [description, by] : descriptions) {
        std::vector<TiffPage> pages = pages_of(1);
        pages.front().description = description;
        write_tiff(folder / "a.tif", "w", pages);
        EXPECT_THAT(
            notes_of(folder / "a.tif"),
            ElementsAre(HasSubstr(std::string("a.tif: 1 of 4 pages is read: the others, which ") + by)));
        pages = pages_of(4);
        pages.front().description = description;
        write_tiff(folder / "b.tif", "w", pages);
        EXPECT_THAT(notes_of(folder / "b.tif"), IsEmpty()) << "each has its directory";
        pages.resize(2);
        pages.back().description = description;
        write_tiff(folder / "c.tif", "w", pages);
        EXPECT_THAT(notes_of(folder / "c.tif"), ElementsAre(HasSubstr("2 of 8 pages are read")));
    }
}

TEST(TiffPages, PicturesThatATagCounts_AreSaidToBePassedOver) {
    const TemporaryFolder folder;
    std::vector<TiffPage> pages = pages_of(1);
    pages.front().metamorph_planes = 4;
    write_tiff(folder / "a.stk", "w", pages);
    EXPECT_THAT(notes_of(folder / "a.stk"), ElementsAre(HasSubstr("1 of 4 pages is read: the others, which "
                                                                  "MetaMorph's tag UIC2 counts")));
    pages = pages_of(1);
    pages.front().depth = 3;
    write_tiff(folder / "b.tif", "w", pages);
    EXPECT_THAT(notes_of(folder / "b.tif"),
                ElementsAre(HasSubstr("1 of 3 pages is read: the others, which the "
                                      "tag ImageDepth")));
}

TEST(TiffPages, AnyByteOfDeflatedPixelsWrong_IsRefused) {
    const TemporaryFolder folder;
    for (const bool tiled : {false, true}) {
        std::vector<TiffPage> pages = pages_of(1);
        pages.front().compression = COMPRESSION_ADOBE_DEFLATE;
        pages.front().is_tiled = tiled;
        write_tiff(folder / "a.tif", "w", pages);
        const auto whole = vision::read_stored(folder / "a.tif");
        ASSERT_TRUE(whole) << whole.error().text;
        const std::string bytes = testing::text_of(folder / "a.tif");
        std::mt19937 random(20261130);
        for (int trial = 0; trial < 60; ++trial) {
            std::string damaged = bytes;
            const std::size_t at = 8 + random() % (bytes.size() / 2);  // pixels come before the directory
            damaged[at] ^= static_cast<char>(1U << random() % 8);
            folder.write("b.tif", damaged);
            const auto read = vision::read_stored(folder / "b.tif");
            EXPECT_TRUE(!read || cv::norm(read->grey, whole->grey, cv::NORM_INF) == 0.0)
                << "trial " << trial << ", byte " << at;
        }
    }
}

}  // namespace
}  // namespace fidservo
