// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Causes (effects and discrepancies) that are added to a rig one by one, each with the size at which it alone
// makes a given gap.
#include "src/selfcheck/draw/case_draw.h"
#include "src/selfcheck/draw/discrepancy_draw.h"
#include "src/selfcheck/draw/gap_alone.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/rounds.h"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// Adds causes to a case. About every second effect is simulated by another formula than the catalogue's
/// (other_formulas.h): if there is none for it, the next effect that has one is.
class SizedCauses {
  public:
    /// @param nominal  must outlive this object
    /// @param drawn  the case whose rig and label the causes are added to; must outlive this object
    /// @param draw  random numbers of the case; must outlive this object
    SizedCauses(const Rig& nominal, Case& drawn, NoiseStream& draw);

    /// Adds an effect of the first class in `order` that is compatible with the effects already added
    /// (can_join()) and reaches the aimed gap with some size. Throws std::runtime_error if there is none.
    void add_effect(const std::vector<std::string_view>& order, const GapAim& aim);

    /// Adds a discrepancy of the first kind in `order` that reaches the aimed gap with some size. Throws
    /// std::runtime_error if there is none.
    void add_discrepancy(const std::vector<DiscrepancyKind>& order, const GapAim& aim);

  private:
    struct Way {
        const EffectDraw* effect;
        bool is_other;  ///< by another formula than the catalogue's
    };

    Way draw_way(std::string_view name);

    /// @param put  adds the cause with a given size to a rig's departures
    template <class Put>
    std::optional<SizedGap> size_of(const Put& put, const SizeRange& sizes, const GapAim& aim) const;

    const Rig& nominal_;
    Case& drawn_;
    NoiseStream& draw_;
    bool other_is_next_;
    std::vector<std::string_view> classes_;
};

/// A gap between two limits, in floors, whose logarithm is uniformly distributed.
GapAim aim_between(double low, double high, NoiseStream& draw);

/// The items in random order.
template <class Item>
std::vector<Item> shuffled(std::span<const Item> items, NoiseStream& draw) {
    std::vector<Item> order(items.begin(), items.end());
    shuffle(order, NoiseStream(draw.bits(), "self-check/order"));
    return order;
}

/// Whether a class may be drawn for one rig with each of the others (can_be_together()).
bool can_join(std::string_view class_name, std::span<const std::string_view> others);

}  // namespace fidservo::selfcheck
