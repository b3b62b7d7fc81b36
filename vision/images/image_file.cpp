// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/image_file.h"

#include "core/demand.h"
#include "core/failure.h"
#include "vision/images/exif.h"
#include "vision/images/jpeg_decoder.h"
#include "vision/images/media.h"
#include "vision/images/png.h"
#include "vision/images/pnm.h"
#include "vision/images/regular_file.h"
#include "vision/images/stated_size.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

/// The file from its beginning on, as many bytes of it as there are; none of what is no regular file.
std::string bytes_of(const std::filesystem::path& file, std::uintmax_t most) {
    std::string bytes;
    if (!demand_regular_file(file)) return bytes;
    std::ifstream in(file, std::ios::binary);
    if (!in) return bytes;
    in.seekg(0, std::ios::end);
    if (const auto size = in.tellg(); size > 0)
        bytes.resize(std::min(most, static_cast<std::uintmax_t>(size)));
    in.seekg(0);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

std::string beginning_of(const std::filesystem::path& file) {
    constexpr std::uintmax_t enough = 1024;
    return bytes_of(file, enough);
}

/// TIFF and BigTIFF, of either byte order.
bool is_tiff(std::string_view bytes) {
    constexpr std::string_view signatures[] = {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}};
    return std::ranges::any_of(signatures, [&](std::string_view one) { return bytes.starts_with(one); });
}

/// The chunks of a WebP's container: what EXIF data say, and whether it is animated.
void look_at_webp(std::string_view file, StoredImage& image) {
    constexpr std::size_t first_chunk_at = 12, header_bytes = 8;
    for (std::size_t at = first_chunk_at; at + header_bytes <= file.size();) {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k)
            length |= std::size_t{static_cast<unsigned char>(file[at + 4 + k])} << (8 * k);
        const std::string_view kind = file.substr(at, 4);
        if (kind == "EXIF") {
            std::string_view exif = file.substr(at + header_bytes, length);
            if (exif.starts_with(std::string_view("Exif\0\0", 6))) exif.remove_prefix(6);
            image.orientation = orientation_of_exif(std::as_bytes(std::span(exif)));
        }
        if (kind == "ANMF") image.has_more_pictures = true;
        at += header_bytes + length + length % 2;
    }
}

Result<StoredImage> decode_jpeg(std::span<const std::byte> bytes) {
    auto grey = JpegDecoder().decode(bytes);
    if (!grey) return tl::make_unexpected(grey.error());
    StoredImage image;
    image.grey = *std::move(grey);
    image.orientation = orientation_of_jpeg(bytes);
    image.has_more_pictures = has_more_pictures(bytes);
    return image;
}

Result<StoredImage> decode_other(const std::filesystem::path& file, std::string_view bytes) {
    const auto stated = stated_size(std::as_bytes(std::span(bytes)));
    if (!stated) return tl::make_unexpected(stated.error());
    auto grey = read_with_opencv(file);
    if (!grey) return tl::make_unexpected(grey.error());
    StoredImage image;
    image.grey = *std::move(grey);
    image.stated_bits = stated->bits;
    if (bytes.starts_with("RIFF")) look_at_webp(bytes, image);
    return image;
}

Result<StoredImage> read_unnamed(const std::filesystem::path& file, std::uint64_t page) {
    if (const Status there = demand_regular_file(file); !there) return tl::make_unexpected(there.error());
    if (is_tiff(beginning_of(file))) return read_tiff_page(file, page);
    std::error_code error;
    if (const auto size = std::filesystem::file_size(file, error); !error && size > most_file_bytes)
        return failure(Reason::device, fmt::format("{} bytes: at most {} are read", size, most_file_bytes));
    const std::string content = bytes_of(file, most_file_bytes);
    const auto bytes = std::as_bytes(std::span(content));
    if (content.empty()) return failure(Reason::device, "it is empty or cannot be opened");
    if (is_png(bytes) || is_jpeg(bytes)) return decode_stored(content);
    if (is_pnm(bytes)) return decode_pnm(bytes);
    return decode_other(file, content);
}

}  // namespace

Result<StoredImage> read_stored(const std::filesystem::path& file, std::uint64_t page) {
    Result<StoredImage> image = read_unnamed(file, page);
    if (!image)
        return failure(Reason::device,
                       fmt::format("{}: cannot be read as an image: {}", file.string(), image.error().text));
    return image;
}

Result<StoredImage> decode_stored(std::string_view content) {
    const auto bytes = std::as_bytes(std::span(content));
    if (is_png(bytes)) return decode_png(bytes);
    if (is_jpeg(bytes)) return decode_jpeg(bytes);
    return failure(Reason::device, "it is neither PNG nor JPEG");
}

int bits_of(const StoredImage& stored) {
    if (stored.grey.depth() != CV_16U) return 8;
    double largest = 0.0;
    cv::minMaxLoc(stored.grey, nullptr, &largest);
    return std::max(stored.stated_bits, bits_for(static_cast<unsigned>(largest)));
}

cv::Mat to_8_bits(const StoredImage& stored, int bits) {
    if (stored.grey.depth() == CV_8U) return stored.grey;
    FIDSERVO_DEMAND(bits >= 8 && bits <= 16);
    const double scale = 255.0 / ((1 << bits) - 1);
    cv::Mat grey;
    if (stored.white_is_zero)
        stored.grey.convertTo(grey, CV_8U, -scale, 255.0);
    else
        stored.grey.convertTo(grey, CV_8U, scale);
    return grey;
}

Result<cv::Mat> read_grey(const std::filesystem::path& file) {
    const Result<StoredImage> image = read_stored(file);
    if (!image) return tl::make_unexpected(image.error());
    return to_8_bits(*image, bits_of(*image));
}

Result<std::vector<PageOfFile>> list_pages(const std::filesystem::path& file) {
    const std::string beginning = beginning_of(file);
    if (!is_tiff(beginning)) {
        const auto bytes = std::as_bytes(std::span(beginning));
        const bool deep = is_png(bytes)   ? is_deep_png(bytes)
                          : is_pnm(bytes) ? is_deep_pnm(bytes)
                                          : is_deep_beginning(bytes);
        return std::vector<PageOfFile>{{.is_deep = deep}};
    }
    auto pages = list_tiff_pages(file);
    if (!pages) return failure(Reason::device, fmt::format("{}: {}", file.string(), pages.error().text));
    return pages;
}

bool begins_as_an_image(const std::filesystem::path& file) {
    const std::string beginning = beginning_of(file);
    if (beginning.empty()) return false;
    const auto bytes = std::as_bytes(std::span(beginning));
    return is_png(bytes) || is_jpeg(bytes) || is_pnm(bytes) || is_tiff(beginning) ||
           is_image_for_opencv(file);
}

}  // namespace fidservo::vision
