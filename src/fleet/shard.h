// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A share of a fleet's tasks.
#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// The K-th of N shares: of tasks that are numbered from 0, those whose number leaves K - 1 when divided by
/// N. Neighbours, which take about as long, go to different shares. All shares together have each task once.
struct Shard {
    std::size_t number = 1;  ///< K, 1 to N
    std::size_t of = 1;      ///< N
};

/// Of "K/N". Throws InputError where it is none.
Shard parse_shard(const std::string& text);

/// The numbers of a share's tasks, in order.
std::vector<std::size_t> tasks_of(const Shard& shard, std::size_t tasks);

}  // namespace fidservo::fleet
