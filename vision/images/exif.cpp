// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/exif.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fidservo::vision {
namespace {

using ByteView = std::span<const std::byte>;

/// Bytes in the order that the data state: "II", least first, or "MM".
class OrderedBytes {
  public:
    OrderedBytes(ByteView bytes, bool least_first) : bytes_(bytes), least_first_(least_first) {}

    /// The number of `count` bytes at a place; 0 beyond the end.
    std::uint32_t at(std::size_t place, std::size_t count) const {
        if (place > bytes_.size() || bytes_.size() - place < count) return 0;
        std::uint32_t number = 0;
        for (std::size_t k = 0; k < count; ++k)
            number = number << 8U |
                     std::to_integer<std::uint32_t>(bytes_[place + (least_first_ ? count - 1 - k : k)]);
        return number;
    }

  private:
    ByteView bytes_;
    bool least_first_;
};

bool begins_with(ByteView bytes, std::string_view text) {
    return bytes.size() >= text.size() &&
           std::ranges::equal(bytes.first(text.size()), std::as_bytes(std::span(text)));
}

/// Calls with(marker, segment) for the segments before the pixels, until it answers true.
template <class With>
bool any_segment(ByteView jpeg, With with) {
    constexpr std::uint32_t start_of_scan = 0xda;
    const OrderedBytes bytes(jpeg, false);
    for (std::size_t at = 2; bytes.at(at, 1) == 0xff;) {
        const std::uint32_t marker = bytes.at(at + 1, 1);
        const std::size_t length = bytes.at(at + 2, 2);
        if (marker == start_of_scan || length < 2 || at + 2 + length > jpeg.size()) return false;
        if (with(marker, jpeg.subspan(at + 4, length - 2))) return true;
        at += 2 + length;
    }
    return false;
}

}  // namespace

int orientation_of_exif(ByteView exif) {
    constexpr std::uint32_t tag = 0x0112;
    constexpr std::size_t entry_bytes = 12, value_at = 8;
    const bool least_first = begins_with(exif, std::string_view("II*\0", 4));
    if (!least_first && !begins_with(exif, std::string_view("MM\0*", 4))) return 1;
    const OrderedBytes bytes(exif, least_first);
    const std::size_t directory = bytes.at(4, 4);
    const std::size_t entries = bytes.at(directory, 2);
    for (std::size_t k = 0; k < entries; ++k) {
        const std::size_t entry = directory + 2 + k * entry_bytes;
        if (bytes.at(entry, 2) != tag) continue;
        const std::uint32_t orientation = bytes.at(entry + value_at, 2);
        return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 1;
    }
    return 1;
}

int orientation_of_jpeg(ByteView jpeg) {
    constexpr std::uint32_t app1 = 0xe1;
    constexpr std::string_view title("Exif\0\0", 6);
    int orientation = 1;
    any_segment(jpeg, [&](std::uint32_t marker, ByteView segment) {
        if (marker != app1 || !begins_with(segment, title)) return false;
        orientation = orientation_of_exif(segment.subspan(title.size()));
        return true;
    });
    return orientation;
}

bool has_more_pictures(ByteView jpeg) {
    constexpr std::uint32_t app2 = 0xe2;
    return any_segment(jpeg, [](std::uint32_t marker, ByteView segment) {
        return marker == app2 && begins_with(segment, std::string_view("MPF\0", 4));
    });
}

}  // namespace fidservo::vision
