// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/stated_size.h"

#include "core/failure.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

std::uint64_t number_at(std::string_view file, std::size_t at, std::size_t count, bool least_first) {
    std::uint64_t number = 0;
    if (at > file.size() || file.size() - at < count) return 0;
    for (std::size_t k = 0; k < count; ++k)
        number = number << 8U | static_cast<unsigned char>(file[at + (least_first ? count - 1 - k : k)]);
    return number;
}

tl::unexpected<Failure> cut_short(std::string_view file, std::uint64_t wanted) {
    return failure(Reason::device,
                   fmt::format("cut short: {} bytes where its header says {}", file.size(), wanted));
}

Result<StatedSize> whole_if(std::string_view file, std::uint64_t wanted, StatedSize stated = {}) {
    if (file.size() < wanted) return cut_short(file, wanted);
    return stated;
}

Status demand_size(std::uint64_t width, std::uint64_t height) {
    if (width == 0 || height == 0) return failure(Reason::device, "its header is damaged");
    return demand_readable_size(width, height);
}

Result<StatedSize> bmp_size(std::string_view file) {
    constexpr std::uint64_t old_header_bytes = 12, uncompressed = 0, by_masks = 3;
    const std::uint64_t pixels_at = number_at(file, 10, 4, true);
    const bool old = number_at(file, 14, 4, true) == old_header_bytes;
    const std::uint64_t width = number_at(file, 18, old ? 2 : 4, true);
    const auto signed_height = static_cast<std::int32_t>(number_at(file, old ? 20 : 22, old ? 2 : 4, true));
    const auto height = static_cast<std::uint64_t>(std::abs(static_cast<std::int64_t>(signed_height)));
    const std::uint64_t bits = number_at(file, old ? 24 : 28, 2, true);
    const std::uint64_t compression = old ? 0 : number_at(file, 30, 4, true);
    if (auto sized = demand_size(width, height); !sized) return tl::make_unexpected(sized.error());
    if (compression == uncompressed || compression == by_masks)
        return whole_if(file, pixels_at + (width * bits + 31) / 32 * 4 * height);
    return whole_if(file, pixels_at + number_at(file, 34, 4, true));
}

Result<StatedSize> webp_size(std::string_view file) {
    return whole_if(file, number_at(file, 4, 4, true) + 8);  // of which no side is above 16383
}

/// From the image's size (marker SIZ) to the end of its code stream (EOC), by the lengths of its tile parts.
/// Source: ISO/IEC 15444-1, annex A.
Result<StatedSize> code_stream_size(std::string_view stream) {
    constexpr std::uint64_t size_marker = 0xff51, tile_part = 0xff90, end_of_stream = 0xffd9;
    constexpr std::size_t first_marker_at = 2, part_length_at = 6;
    if (number_at(stream, first_marker_at, 2, false) != size_marker)
        return failure(Reason::device, "its header is damaged");
    const auto field = [&](std::size_t k) { return number_at(stream, 8 + 4 * k, 4, false); };
    if (auto sized = demand_size(field(0) - field(2), field(1) - field(3)); !sized)
        return tl::make_unexpected(sized.error());
    constexpr std::size_t depth_at = 42;
    const auto bits = static_cast<int>(number_at(stream, depth_at, 1, false) & 0x7fU) + 1;
    const StatedSize stated{bits > 8, bits > 8 && bits < 16 ? bits : 0};
    for (std::size_t at = first_marker_at; at + 2 <= stream.size();) {
        const std::uint64_t marker = number_at(stream, at, 2, false);
        if (marker == end_of_stream) return stated;
        if (marker == tile_part) {
            const std::uint64_t length = number_at(stream, at + part_length_at, 4, false);
            if (length == 0 && number_at(stream, stream.size() - 2, 2, false) == end_of_stream) return stated;
            if (length < 12) break;
            at += length;
        } else {
            at += 2 + number_at(stream, at + 2, 2, false);
        }
    }
    return failure(Reason::device, "cut short: its code stream does not end");
}

/// The box "jp2c" holds the code stream.
Result<StatedSize> jp2_size(std::string_view file) {
    for (std::size_t at = 0; at + 8 <= file.size();) {
        std::uint64_t length = number_at(file, at, 4, false);
        const std::string_view kind = file.substr(at + 4, 4);
        std::size_t header = 8;
        if (length == 1) {
            length = number_at(file, at + 8, 8, false);
            header = 16;
        }
        if (length == 0) length = file.size() - at;
        if (length < header || length > file.size() - at) break;
        if (kind == "jp2c") return code_stream_size(file.substr(at + header, length - header));
        at += length;
    }
    return failure(Reason::device, "cut short: its code stream is not whole");
}

Result<StatedSize> sun_raster_size(std::string_view file) {
    constexpr std::size_t header_bytes = 32;
    constexpr std::uint64_t run_length_encoded = 2;
    const auto field = [&](std::size_t k) { return number_at(file, 4 * k, 4, false); };
    const std::uint64_t width = field(1), height = field(2), bits = field(3), kind = field(5);
    if (auto sized = demand_size(width, height); !sized) return tl::make_unexpected(sized.error());
    if (bits == 8 && field(7) == 0)
        return failure(Reason::device, "a Sun raster of grey without a colour map is not read");
    const std::uint64_t pixels =
        kind == run_length_encoded ? field(4) : (width * bits + 15) / 16 * 2 * height;
    return whole_if(file, header_bytes + field(7) + pixels);
}

bool begins(std::string_view file, std::string_view with) {
    return file.starts_with(with);
}

bool is_jp2(std::string_view file) {
    return begins(file, std::string_view("\0\0\0\x0cjP  ", 8));
}

bool is_code_stream(std::string_view file) {
    return begins(file, "\xff\x4f\xff\x51");
}

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Result<StatedSize> stated_size(std::span<const std::byte> bytes) {
    const std::string_view file = text_of(bytes);
    for (const std::string_view of_floats : {"#?RADIANCE", "#?RGBE", "PF\n", "Pf\n", "\x76\x2f\x31\x01"})
        if (begins(file, of_floats))
            return failure(Reason::device, "floating-point samples have no white: save it with 8 or 16 bits");
    if (begins(file, "BM")) return bmp_size(file);
    if (begins(file, "RIFF")) return webp_size(file);
    if (is_jp2(file)) return jp2_size(file);
    if (is_code_stream(file)) return code_stream_size(file);
    if (begins(file, "\x59\xa6\x6a\x95")) return sun_raster_size(file);
    return StatedSize{};
}

bool is_deep_beginning(std::span<const std::byte> bytes) {
    const std::string_view beginning = text_of(bytes);
    return is_jp2(beginning) || is_code_stream(beginning);  // the depth may come late
}

}  // namespace fidservo::vision
