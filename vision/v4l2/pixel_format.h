// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pixel formats that are understood, and what they are called.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo::vision::v4l2 {

/// In the order in which they are preferred.
enum class PixelFormat {
    grey,   ///< GREY: 8 bit
    y16,    ///< Y16: 16 bit, little endian
    y12,    ///< Y12: 12 bit in the low bits of 16
    y10,    ///< Y10: likewise
    yuyv,   ///< YUYV: 4:2:2, luma in the even bytes
    mjpeg,  ///< MJPG: a JPEG a frame
};

inline constexpr std::array pixel_formats{PixelFormat::grey, PixelFormat::y16,  PixelFormat::y12,
                                          PixelFormat::y10,  PixelFormat::yuyv, PixelFormat::mjpeg};

/// GREY, Y16, Y12, Y10, YUYV, MJPEG: as rig files and messages write them.
std::string_view name_of(PixelFormat format);
std::optional<PixelFormat> pixel_format_named(std::string_view name);

/// The system's four characters as a number, and back.
std::uint32_t fourcc_of(PixelFormat format);
std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc);
/// "YUYV"; "Y16 -BE" for big endian, as v4l2-ctl writes it. Characters that cannot be printed become '?'.
std::string fourcc_text(std::uint32_t fourcc);

/// Bytes of a pixel; nothing for compressed formats.
std::optional<int> bytes_per_pixel(PixelFormat format);

}  // namespace fidservo::vision::v4l2
