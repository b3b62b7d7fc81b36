// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/stated_length.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace fidservo::vision {
namespace {

class Bytes {
  public:
    explicit Bytes(const char* file) : stream_(file, std::ios::binary) {}

    void go_to(std::uint64_t place) { stream_.seekg(static_cast<std::streamoff>(place)); }
    std::uint64_t place() { return static_cast<std::uint64_t>(stream_.tellg()); }
    bool is_good() const { return stream_.good(); }

    std::uint64_t number(int count, bool least_first) {
        std::uint64_t value = 0;
        for (int k = 0; k < count; ++k) {
            const auto byte = static_cast<std::uint64_t>(stream_.get() & 0xff);
            value = least_first ? value | byte << (8 * k) : value << 8U | byte;
        }
        return value;
    }

    std::string text(std::size_t count) {
        std::string text(count, '\0');
        stream_.read(text.data(), static_cast<std::streamsize>(count));
        return text;
    }

  private:
    std::ifstream stream_;
};

/// A length of one to eight bytes (RFC 8794); empty if it is not stated.
std::optional<std::uint64_t> ebml_length(Bytes& bytes) {
    std::uint64_t value = bytes.number(1, false);
    int more = 0;
    while (more < 7 && (value & (0x80U >> more)) == 0) ++more;
    value &= 0x7fU >> more;
    for (int k = 0; k < more; ++k) value = value << 8U | bytes.number(1, false);
    const std::uint64_t unknown = (std::uint64_t{1} << (7 * (more + 1))) - 1;
    return value == unknown ? std::nullopt : std::optional(value);
}

std::uint64_t matroska_length(Bytes& bytes) {
    constexpr std::uint64_t segment = 0x18538067;
    const auto header = ebml_length(bytes);
    if (!header) return 0;
    bytes.go_to(bytes.place() + *header);
    if (bytes.number(4, false) != segment) return 0;
    const auto length = ebml_length(bytes);
    return length && bytes.is_good() ? bytes.place() + *length : 0;
}

/// AVI of more than a GB goes on in further chunks "RIFF".
std::uint64_t avi_length(Bytes& bytes) {
    constexpr std::uint64_t riff = 0x52494646, header_bytes = 8;
    std::uint64_t end = 0;
    bytes.go_to(0);
    while (bytes.number(4, false) == riff && bytes.is_good()) {
        end += header_bytes + bytes.number(4, true);
        bytes.go_to(end);
    }
    return end;
}

/// MP4 and its kin: boxes one behind the other, of which the last may go to the end.
std::uint64_t mp4_length(Bytes& bytes) {
    constexpr std::array<std::string_view, 12> known{"ftyp", "moov", "mdat", "free", "skip", "wide",
                                                     "moof", "mfra", "sidx", "styp", "uuid", "udta"};
    constexpr std::uint64_t is_long = 1;
    std::uint64_t end = 0;
    while (true) {
        bytes.go_to(end);
        std::uint64_t length = bytes.number(4, false), header = 8;
        const std::string kind = bytes.text(4);
        if (length == is_long) {
            length = bytes.number(8, false);
            header = 16;
        }
        if (!bytes.is_good() || length < header || std::ranges::find(known, kind) == known.end()) return end;
        end += length;
    }
}

/// Ogg's pages (RFC 3533): a header of 27 bytes, the lengths of its parts, and these. The last page of each
/// stream is marked.
StatedEnd ogg_end(Bytes& bytes) {
    constexpr std::uint64_t flags_at = 5, serial_at = 14, parts_at = 26, header_bytes = 27, last_page = 4;
    std::uint64_t end = 0;
    std::set<std::uint64_t> open;
    while (true) {
        const std::uint64_t page = end;
        bytes.go_to(page);
        if (bytes.text(4) != "OggS") break;
        bytes.go_to(page + flags_at);
        const bool is_last = (bytes.number(1, false) & last_page) != 0;
        bytes.go_to(page + serial_at);
        const std::uint64_t serial = bytes.number(4, false);
        bytes.go_to(page + parts_at);
        const std::uint64_t parts = bytes.number(1, false);
        std::uint64_t length = header_bytes + parts;
        for (std::uint64_t k = 0; k < parts; ++k) length += bytes.number(1, false);
        if (!bytes.is_good()) return {page + header_bytes + parts, true};
        end = page + length;
        if (is_last)
            open.erase(serial);
        else
            open.insert(serial);
    }
    return {end, !open.empty()};
}

}  // namespace

StatedEnd stated_end(const char* file) {
    constexpr std::uint64_t ebml = 0x1a45dfa3, riff = 0x52494646, oggs = 0x4f676753;
    Bytes bytes(file);
    const std::uint64_t begin = bytes.number(4, false);
    if (!bytes.is_good()) return {};
    if (begin == ebml) return {matroska_length(bytes)};
    if (begin == riff) return {avi_length(bytes)};
    if (begin == oggs) return ogg_end(bytes);
    return {mp4_length(bytes)};
}

}  // namespace fidservo::vision
