// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// CDR, the encoding of ROS 2's messages (OMG DDS-XTypes 1.3, 7.4: XCDR version 1, plain): values are aligned
// to their size, relative to the end of the four-byte header, which states the byte order.
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::imports {

/// A message that does not have the structure of its type.
class CdrError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

class CdrReader {
  public:
    /// Throws CdrError: too short, or another encoding.
    explicit CdrReader(std::string_view message);

    // Each throws CdrError where the message is too short for it.
    template <class Number>
    Number number() {
        Number value{};
        std::string_view bytes = aligned(sizeof(Number));
        if (is_swapped_) {
            char reversed[sizeof(Number)];
            for (std::size_t k = 0; k < sizeof(Number); ++k) reversed[k] = bytes[sizeof(Number) - 1 - k];
            std::memcpy(&value, reversed, sizeof value);
        } else {
            std::memcpy(&value, bytes.data(), sizeof value);
        }
        return value;
    }
    std::string text();                              ///< without its final zero
    std::string_view octets();                       ///< a sequence of them
    std::vector<double> doubles();                   ///< a sequence of them
    std::vector<std::string> texts();                ///< likewise
    std::vector<double> doubles(std::size_t count);  ///< an array

  private:
    std::string_view aligned(std::size_t size);
    std::string_view take(std::size_t size);
    /// Reads the length of a sequence whose elements take at least `least_bytes` each. Throws CdrError if the
    /// message is too short for that.
    std::size_t length(std::size_t least_bytes);

    std::string_view body_;
    std::size_t at_ = 0;
    bool is_swapped_ = false;
};

/// Reads a std_msgs/Header.
/// @return its stamp in ns since 1970; 0 if it was not set
std::int64_t read_header(CdrReader& cdr);

}  // namespace fidservo::imports
