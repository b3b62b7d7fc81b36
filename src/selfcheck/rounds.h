#pragma once
// Draws that are even: nothing is met again before all was met.
#include "core/random.h"
#include "src/selfcheck/label.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::selfcheck {

inline std::size_t index_below(NoiseStream& draw, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(draw.uniform() * static_cast<double>(count)));
}

template <class Item>
void shuffle(std::vector<Item>& items, NoiseStream draw) {
    for (std::size_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[index_below(draw, k)]);
}

/// Round robin: item k of a list that is shuffled anew whenever all of it was met.
template <class Item>
Item met(std::span<const Item> items, std::uint64_t seed, CaseKind kind, std::size_t k) {
    std::vector<Item> round(items.begin(), items.end());
    shuffle(round, NoiseStream(seed, fmt::format("self-check/round/{}/{}", name_of(kind), k / items.size())));
    return round[k % items.size()];
}

}  // namespace fidservo::selfcheck
