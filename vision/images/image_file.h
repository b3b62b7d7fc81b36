// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Images as files: 8-bit grey, in and out.

#include "core/failure.h"
#include "core/result.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The longest side of an image that is read: small tags are looked for at twice the resolution, and the tag
/// library takes sides below 2^15 px. A header that claims more is refused before memory is taken; so is one
/// whose pixels cannot come out of so small a file by its compression (1032 : 1 at most for PNG).
inline constexpr std::uint64_t most_side_px = (1U << 14) - 1;
/// Pixels of the largest image that is read.
inline constexpr std::uint64_t most_pixels = most_side_px * most_side_px;

/// Fails with Reason::device if a side is longer than most_side_px.
inline Status demand_readable_size(std::uint64_t width_px, std::uint64_t height_px) {
    if (width_px <= most_side_px && height_px <= most_side_px) return {};
    return failure(Reason::device, std::to_string(width_px) + " x " + std::to_string(height_px) +
                                       " px: sides of at most " + std::to_string(most_side_px) +
                                       " px are read");
}

/// The largest file of one image that is read: most_pixels of four samples of 16 bits, not compressed. A TIFF
/// of many pages may be larger.
inline constexpr std::uintmax_t most_file_bytes = std::uintmax_t{1} << 31;

/// An image with the samples that its file has, as grey: colour becomes luma (ITU-R BT.601), transparency is
/// dropped.
struct StoredImage {
    cv::Mat grey;  ///< CV_8UC1, 255 is white; or CV_16UC1, of which to_8_bits() has to be told the range
    int stated_bits = 0;  ///< of CV_16UC1: how many bits the file says that it uses, 8 to 16; 0: it does not
    bool white_is_zero = false;      ///< of CV_16UC1: 0 is white
    int orientation = 1;             ///< as EXIF numbers them, 1 to 8; the pixels are not turned
    bool has_more_pictures = false;  ///< of which this is the first; the others are not read
};

/// An image, or a page of a TIFF. Pixels are where the file has them: an orientation tag is not followed.
/// PNG, JPEG, TIFF, and what OpenCV's codecs read of other formats (BMP, PNM, WebP, JPEG 2000, Sun raster).
/// The format is told by the file's first bytes. Fails with Reason::device, naming the file: not there, no
/// image, damaged or cut short, of floating-point samples (which have no white), sides beyond most_side_px or
/// most_file_bytes. Where a format has no checksum, a wrong byte may not be noticed; a missing one is.
/// Thread-safe.
/// @param page  the place of a TIFF's page in its file, as list_pages() gives it; 0: its first image
Result<StoredImage> read_stored(const std::filesystem::path& file, std::uint64_t page = 0);

/// The number of bits, from 8 to 16, that hold a value.
constexpr int bits_for(unsigned largest) {
    return std::clamp(static_cast<int>(std::bit_width(largest)), 8, 16);
}

/// The bits of an image alone: those that the file states or, if these are more, that its largest value
/// needs.
int bits_of(const StoredImage& stored);

/// CV_8UC1 of an image whose full scale is 2^bits - 1: that becomes 255, rounded to nearest; what is above
/// it, too. An image of 8 bits is as it was.
cv::Mat to_8_bits(const StoredImage& stored, int bits);

/// An image alone, as CV_8UC1, full scale as bits_of() has it. Fails as read_stored() does.
Result<cv::Mat> read_grey(const std::filesystem::path& file);

/// A picture in a file, without its pixels.
struct PageOfFile {
    std::uint64_t page = 0;  ///< for read_stored()
    bool is_deep = false;    ///< its samples may have more than 8 bits
    std::string damage{};    ///< why it cannot be read; empty if that has yet to be seen
};

/// The pictures of an image file: a TIFF's pages, without reduced copies and masks; one of any other file.
/// Looks at the beginning of the file, or at the headers of a TIFF's pages. A file that is not there or no
/// image has one page as well, which read_stored() refuses. Where a TIFF's list of pages is broken off, the
/// last page is one with a damage. Fails with Reason::device: more than most_pages.
Result<std::vector<PageOfFile>> list_pages(const std::filesystem::path& file);
/// Pages of the longest file that is read.
inline constexpr std::size_t most_pages = 65535;

/// Do the first bytes of the file make it an image of a format that is read?
bool begins_as_an_image(const std::filesystem::path& file);

/// @param grey  CV_8UC1
/// @param compression  1 (fast) to 9 (small)
std::vector<unsigned char> encode_png(const cv::Mat& grey, int compression);

/// @param grey  CV_8UC1
/// @param quality  1 to 100
std::vector<unsigned char> encode_jpeg(const cv::Mat& grey, int quality);

}  // namespace fidservo::vision
