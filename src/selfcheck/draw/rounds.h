// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Random draws without repetition: nothing is drawn again before everything has been drawn.
#include "core/random.h"
#include "src/selfcheck/draw/label.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
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

/// Item k of an endless sequence in which the whole list is repeated, in a new random order each time.
template <class Item>
Item met(std::span<const Item> items, std::uint64_t seed, CaseKind kind, std::size_t k) {
    std::vector<Item> round(items.begin(), items.end());
    shuffle(round, NoiseStream(seed, fmt::format("self-check/round/{}/{}", name_of(kind), k / items.size())));
    return round[k % items.size()];
}

/// The kinds of cases in random order, reshuffled after each round.
class KindCycle {
  public:
    /// @param name  of the random numbers' stream
    constexpr KindCycle(std::span<const CaseKind> kinds, std::string_view name)
        : kinds_(kinds), name_(name) {}

    bool has(CaseKind kind) const { return std::ranges::find(kinds_, kind) != kinds_.end(); }

    CaseKind kind_of(std::uint64_t seed, std::size_t number) const {
        return shuffled(seed, number)[number % kinds_.size()];
    }

    /// The number of earlier cases of the same kind.
    std::size_t ordinal_of(std::uint64_t seed, std::size_t number) const {
        const std::vector<CaseKind> kinds = shuffled(seed, number);
        const auto here = kinds.begin() + static_cast<std::ptrdiff_t>(number % kinds.size());
        const auto in_cycle = std::ranges::count(kinds, *here),
                   before = std::count(kinds.begin(), here, *here);
        return number / kinds.size() * static_cast<std::size_t>(in_cycle) + static_cast<std::size_t>(before);
    }

  private:
    std::vector<CaseKind> shuffled(std::uint64_t seed, std::size_t number) const {
        std::vector<CaseKind> kinds(kinds_.begin(), kinds_.end());
        shuffle(kinds, NoiseStream(seed, fmt::format("self-check/{}/{}", name_, number / kinds.size())));
        return kinds;
    }

    std::span<const CaseKind> kinds_;
    std::string_view name_;
};

}  // namespace fidservo::selfcheck
