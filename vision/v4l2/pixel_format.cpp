// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/pixel_format.h"

#include <algorithm>

#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

struct Known {
    PixelFormat format;
    std::string_view name;
    std::uint32_t fourcc;
    std::optional<int> bytes;
};

constexpr std::array<Known, pixel_formats.size()> known{{
    {PixelFormat::grey, "GREY", V4L2_PIX_FMT_GREY, 1},
    {PixelFormat::y16, "Y16", V4L2_PIX_FMT_Y16, 2},
    {PixelFormat::y12, "Y12", V4L2_PIX_FMT_Y12, 2},
    {PixelFormat::y10, "Y10", V4L2_PIX_FMT_Y10, 2},
    {PixelFormat::yuyv, "YUYV", V4L2_PIX_FMT_YUYV, 2},
    {PixelFormat::mjpeg, "MJPEG", V4L2_PIX_FMT_MJPEG, std::nullopt},
}};

const Known& about(PixelFormat format) {
    return known[static_cast<std::size_t>(format)];
}

template <class Condition>
std::optional<PixelFormat> first_that(const Condition& condition) {
    const auto* found = std::ranges::find_if(known, condition);
    if (found == known.end()) return std::nullopt;
    return found->format;
}

}  // namespace

std::string_view name_of(PixelFormat format) {
    return about(format).name;
}

std::optional<PixelFormat> pixel_format_named(std::string_view name) {
    return first_that([&](const Known& one) { return one.name == name; });
}

std::uint32_t fourcc_of(PixelFormat format) {
    return about(format).fourcc;
}

std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc) {
    return first_that([&](const Known& one) { return one.fourcc == fourcc; });
}

std::string fourcc_text(std::uint32_t fourcc) {
    constexpr std::uint32_t big_endian = 1U << 31U;
    std::string text;
    for (unsigned shift = 0; shift < 32; shift += 8) {
        const auto c = static_cast<char>(((fourcc & ~big_endian) >> shift) & 0xffU);
        text += c >= ' ' && c <= '~' ? c : '?';
    }
    if ((fourcc & big_endian) != 0) return text + "-BE";
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

std::optional<int> bytes_per_pixel(PixelFormat format) {
    return about(format).bytes;
}

}  // namespace fidservo::vision::v4l2
