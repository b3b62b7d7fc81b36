// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/stated_length.h"

#include <fstream>
#include <optional>
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

}  // namespace

std::uint64_t stated_length(const char* file) {
    constexpr std::uint64_t ebml = 0x1a45dfa3, riff = 0x52494646;
    Bytes bytes(file);
    const std::uint64_t begin = bytes.number(4, false);
    if (!bytes.is_good()) return 0;
    if (begin == ebml) return matroska_length(bytes);
    return begin == riff ? avi_length(bytes) : 0;
}

}  // namespace fidservo::vision
