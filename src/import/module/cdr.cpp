// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/cdr.h"

#include <fmt/format.h>

namespace fidservo::imports {

CdrReader::CdrReader(std::string_view message) {
    constexpr std::size_t encapsulation = 4;
    if (message.size() < encapsulation) throw CdrError("is shorter than its encapsulation");
    const auto kind = static_cast<unsigned char>(message[1]);
    if (message[0] != 0 || kind > 1)
        throw CdrError(fmt::format("its encoding {:#04x} is not plain CDR", kind));
    is_swapped_ = (kind == 0) == (std::endian::native == std::endian::little);
    body_ = message.substr(encapsulation);
}

std::string_view CdrReader::take(std::size_t size) {
    if (size > body_.size() - at_) throw CdrError("breaks off");
    const std::string_view taken = body_.substr(at_, size);
    at_ += size;
    return taken;
}

std::string_view CdrReader::aligned(std::size_t size) {
    take((size - at_ % size) % size);
    return take(size);
}

std::size_t CdrReader::length(std::size_t least_bytes) {
    const auto count = std::size_t{number<std::uint32_t>()};
    if (count > (body_.size() - at_) / least_bytes) throw CdrError("breaks off in a sequence");
    return count;
}

std::string CdrReader::text() {
    const std::string_view bytes = take(length(1));
    return std::string(bytes.substr(0, bytes.find('\0')));
}

std::string_view CdrReader::octets() {
    return take(length(1));
}

std::vector<double> CdrReader::doubles(std::size_t count) {
    std::vector<double> values;
    values.reserve(count);
    for (std::size_t k = 0; k < count; ++k) values.push_back(number<double>());
    return values;
}

std::vector<double> CdrReader::doubles() {
    return doubles(length(sizeof(double)));
}

std::vector<std::string> CdrReader::texts() {
    std::vector<std::string> all(length(sizeof(std::uint32_t)));
    for (std::string& one : all) one = text();
    return all;
}

std::int64_t read_header(CdrReader& cdr) {
    constexpr std::int64_t ns_of_a_second = 1'000'000'000;
    const std::int64_t whole_s = cdr.number<std::int32_t>();
    const std::int64_t rest_ns = cdr.number<std::uint32_t>();
    (void)cdr.text();  // the frame's name
    return whole_s * ns_of_a_second + rest_ns;
}

}  // namespace fidservo::imports
