// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/shard.h"

#include "core/input_error.h"

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

std::optional<std::size_t> count_of(std::string_view text) {
    std::size_t count = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, count);
    if (error != std::errc() || rest != end) return std::nullopt;
    return count;
}

}  // namespace

Shard parse_shard(const std::string& text) {
    const auto slash = text.find('/');
    if (slash != std::string::npos) {
        const auto number = count_of(std::string_view(text).substr(0, slash));
        const auto of = count_of(std::string_view(text).substr(slash + 1));
        if (number && of && *number >= 1 && *number <= *of) return {*number, *of};
    }
    throw InputError(fmt::format("--shard: {}: must be K/N, with K from 1 to N: 1/16 to 16/16", text));
}

std::vector<std::size_t> tasks_of(const Shard& shard, std::size_t tasks) {
    std::vector<std::size_t> numbers;
    for (std::size_t task = shard.number - 1; task < tasks; task += shard.of) numbers.push_back(task);
    return numbers;
}

}  // namespace fidservo::fleet
