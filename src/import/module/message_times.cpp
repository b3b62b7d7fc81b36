// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/message_times.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// The place of the message whose stamp of 0 is a time; one past the last: there is none.
std::size_t stamped_at_zero(std::span<const std::int64_t> stamps) {
    const auto next = std::ranges::find_if(stamps, [](std::int64_t stamp) { return stamp != 0; });
    const auto most = std::ranges::max_element(stamps);
    const bool is_near = next != stamps.begin() && *next > 0 && *next <= std::max(*most - *next, second_ns);
    return is_near ? static_cast<std::size_t>(next - stamps.begin()) - 1 : stamps.size();
}

}  // namespace

std::string MessageTimes::note() const {
    if (!are_stamps) return "its messages have no stamps: times are those at which the bag received them";
    if (unstamped == 0) return {};
    return fmt::format("{} of {} messages have no stamp: they are left out", unstamped,
                       order.size() + unstamped);
}

MessageTimes times_of_messages(std::span<const std::int64_t> stamps, std::span<const std::int64_t> received) {
    MessageTimes times;
    times.are_stamps = std::ranges::any_of(stamps, [](std::int64_t stamp) { return stamp != 0; });
    const std::span<const std::int64_t> from = times.are_stamps ? stamps : received;
    times.order.resize(from.size());
    std::iota(times.order.begin(), times.order.end(), 0);
    if (times.are_stamps) {
        const std::size_t at_zero = stamped_at_zero(stamps);
        times.unstamped =
            std::erase_if(times.order, [&](std::size_t k) { return stamps[k] == 0 && k != at_zero; });
    }
    std::ranges::stable_sort(times.order, {}, [&](std::size_t k) { return from[k]; });
    for (const std::size_t k : times.order) times.ns.push_back(from[k]);
    return times;
}

}  // namespace fidservo::imports
