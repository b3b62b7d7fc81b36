// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A share of a fleet's tasks.
#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// The K-th of N shares: the tasks whose number, counted from 0, is K - 1 modulo N. Neighbouring tasks, which
/// usually take about the same time, are thus in different shares. Each task is in exactly one share.
struct Shard {
    std::size_t number = 1;  ///< K, 1 to N
    std::size_t of = 1;      ///< N
};

/// Parses "K/N". Throws InputError if the text is not of this form.
Shard parse_shard(const std::string& text);

/// The numbers of a share's tasks, in order.
std::vector<std::size_t> tasks_of(const Shard& shard, std::size_t tasks);

}  // namespace fidservo::fleet
