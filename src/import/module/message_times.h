// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The times of messages of ROS 2: by their own stamps, or by when they were received.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fidservo::imports {

struct MessageTimes {
    bool are_stamps = false;           ///< or else the times at which the bag received the messages
    std::vector<std::size_t> order{};  ///< the messages that have a time, in the order of their times
    std::vector<std::int64_t> ns{};    ///< their times, in that order
    std::size_t unstamped = 0;         ///< messages without a stamp, where others have one: left out

    /// What a user would want to know, in one sentence after the topic's name; empty: nothing.
    std::string note() const;
};

/// A stamp that nobody set is 0. So is the first one of a simulation: a 0 before all other stamps is a time
/// where the next stamp is no farther from it than the stamps' own span, or a second; of several the last
/// one received.
/// @param stamps  in the order of reception; empty: the messages have none
/// @param received  as many, or all where there are no stamps
MessageTimes times_of_messages(std::span<const std::int64_t> stamps, std::span<const std::int64_t> received);

}  // namespace fidservo::imports
