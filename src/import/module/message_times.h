// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The times of ROS 2 messages: their own stamps, or the times of reception.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fidservo::imports {

struct MessageTimes {
    bool are_stamps = false;           ///< whether `ns` are stamps; otherwise the times of reception
    std::vector<std::size_t> order{};  ///< the messages that have a time, in the order of their times
    std::vector<std::int64_t> ns{};    ///< their times, in that order
    std::size_t unstamped = 0;         ///< messages without a stamp, where others have one: left out

    /// A note for the user, one sentence without its subject, the topic; empty: none.
    std::string note() const;
};

/// A stamp that was not set is 0, but the first stamp of a simulation may be 0, too. A 0 counts as a time if
/// it is received before all other stamps and the next stamp is no later than the span of the stamps or 1 s;
/// of several such zeros, only the last one received.
/// @param stamps  in the order of reception; empty: the messages have none
/// @param received  as many, or all where there are no stamps
MessageTimes times_of_messages(std::span<const std::int64_t> stamps, std::span<const std::int64_t> received);

}  // namespace fidservo::imports
