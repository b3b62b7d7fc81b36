// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Reading and writing image files as 8-bit grey.

#include "core/failure.h"
#include "core/result.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The longest side of an image that is read: small tags are looked for at twice the resolution, and the tag
/// library takes sides below 2^15 px. A header that claims more is refused before memory is taken; so is one
/// that claims more pixels than its compression can hold in a file of that size (1032 : 1 at most for PNG).
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

/// An image as grey, with the sample depth of its file: colour becomes luma (ITU-R BT.601), transparency is
/// dropped.
struct StoredImage {
    cv::Mat grey;  ///< CV_8UC1, 255 is white; or CV_16UC1, whose full scale is the `bits` of to_8_bits()
    /// of CV_16UC1: how many bits the file states to be in use, 8 to 16; 0: it does not state it.
    int stated_bits = 0;
    bool white_is_zero = false;      ///< of CV_16UC1: 0 is white, as in an inverted scale
    int orientation = 1;             ///< EXIF orientation, 1 to 8; the pixels are not rotated accordingly
    bool has_more_pictures = false;  ///< the file has further pictures, which are not read
};

/// An image, or a page of a TIFF. Pixels are in the order of the file: an orientation tag is not applied.
/// PNG, JPEG, TIFF, and what OpenCV's codecs read of other formats (BMP, PNM, WebP, JPEG 2000, Sun raster).
/// The format is recognised by the file's first bytes. Fails with Reason::device, naming the file: not there,
/// no image, damaged or truncated, of floating-point samples (which have no white), sides beyond most_side_px
/// or most_file_bytes. In a format without checksum a wrong byte may go unnoticed; a missing one does not.
/// Thread-safe.
/// @param page  the place of a TIFF's page in its file, as list_pages() gives it; 0: its first image
Result<StoredImage> read_stored(const std::filesystem::path& file, std::uint64_t page = 0);

/// The image of a PNG's or a JPEG's bytes. Fails as read_stored() does, without a file's name.
Result<StoredImage> decode_stored(std::string_view bytes);

/// The number of bits, from 8 to 16, that hold a value.
constexpr int bits_for(unsigned largest) {
    return std::clamp(static_cast<int>(std::bit_width(largest)), 8, 16);
}

/// The number of bits of a single image's samples: as the file states, or as many as its largest value needs
/// if that is more.
int bits_of(const StoredImage& stored);

/// The image as CV_8UC1: full scale, 2^bits - 1, and what is above becomes 255, the rest in proportion,
/// rounded. An 8-bit image is returned unchanged.
cv::Mat to_8_bits(const StoredImage& stored, int bits);

/// Reads a single image as CV_8UC1, its full scale given by bits_of(). Fails as read_stored() does.
Result<cv::Mat> read_grey(const std::filesystem::path& file);

/// A picture in a file, without its pixels.
struct PageOfFile {
    std::uint64_t page = 0;  ///< the argument `page` of read_stored()
    bool is_deep = false;    ///< its samples may have more than 8 bits
    std::string damage{};    ///< why it cannot be read; empty if no reason is known yet
    std::string note{};      ///< what else the file holds that is no page, in one line; mostly empty
};

/// The pictures of an image file: of a TIFF its pages, without thumbnails and masks; of any other file one.
/// Reads only the beginning of the file, or the headers of a TIFF's pages. A file that is missing or no image
/// has one page as well, which read_stored() refuses. Where a TIFF's list of pages is broken, the last page
/// has its `damage` set. Fails with Reason::device for more than most_pages.
Result<std::vector<PageOfFile>> list_pages(const std::filesystem::path& file);
/// The largest number of pages of a file that is read.
inline constexpr std::size_t most_pages = 65535;

/// Whether the first bytes of the file are those of an image format that is read.
bool begins_as_an_image(const std::filesystem::path& file);

/// @param grey  CV_8UC1
/// @param compression  1 (fast) to 9 (small)
std::vector<unsigned char> encode_png(const cv::Mat& grey, int compression);

/// @param grey  CV_8UC1
/// @param quality  1 to 100
std::vector<unsigned char> encode_jpeg(const cv::Mat& grey, int quality);

}  // namespace fidservo::vision
