// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The supported pixel formats and their names.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo::vision::v4l2 {

/// In the order of preference.
enum class PixelFormat {
    grey,   ///< GREY: 8 bit
    y16,    ///< Y16: 16 bit, little endian
    y12,    ///< Y12: 12 bit in the low bits of 16
    y10,    ///< Y10: 10 bit in the low bits of 16
    yuyv,   ///< YUYV: 4:2:2, luma in the even bytes
    mjpeg,  ///< MJPG: one JPEG per frame
};

inline constexpr std::array pixel_formats{PixelFormat::grey, PixelFormat::y16,  PixelFormat::y12,
                                          PixelFormat::y10,  PixelFormat::yuyv, PixelFormat::mjpeg};

/// GREY, Y16, Y12, Y10, YUYV, MJPEG: as rig files and messages write them.
std::string_view name_of(PixelFormat format);
std::optional<PixelFormat> pixel_format_named(std::string_view name);

/// The system's four-character code of a format, and the reverse.
std::uint32_t fourcc_of(PixelFormat format);
std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc);
/// A four-character code as text: "YUYV"; "Y16 -BE" for big endian, as v4l2-ctl writes it. Unprintable
/// characters become '?'.
std::string fourcc_text(std::uint32_t fourcc);

/// Bytes per pixel; empty for compressed formats.
std::optional<int> bytes_per_pixel(PixelFormat format);

}  // namespace fidservo::vision::v4l2
