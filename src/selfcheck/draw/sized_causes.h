// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Causes that are put into a rig one by one, each so large that alone it makes a gap that was drawn.
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

/// Every second effect, or the next after it that can be, is made by another formula than the catalogue's
/// (other_formulas.h).
class SizedCauses {
  public:
    /// @param nominal  is referred to
    /// @param drawn    the case whose rig and label they are put into; is referred to
    /// @param draw     of the case; is referred to
    SizedCauses(const Rig& nominal, Case& drawn, NoiseStream& draw);

    /// Of the classes in their order, the first one that can be together with those before it and that comes
    /// to the aim. Throws std::runtime_error where none does.
    void add_effect(const std::vector<std::string_view>& order, const GapAim& aim);

    /// Of the kinds in their order, the first one that comes to the aim. Throws std::runtime_error where none
    /// does.
    void add_discrepancy(const std::vector<DiscrepancyKind>& order, const GapAim& aim);

  private:
    struct Way {
        const EffectDraw* effect;
        bool is_other;  ///< by another formula than the catalogue's
    };

    Way draw_way(std::string_view name);

    /// @param put  puts the cause of a size into a rig's departures
    template <class Put>
    std::optional<SizedGap> size_of(const Put& put, const SizeRange& sizes, const GapAim& aim) const;

    const Rig& nominal_;
    Case& drawn_;
    NoiseStream& draw_;
    bool other_is_next_;
    std::vector<std::string_view> classes_;
};

/// A gap that is drawn evenly in the logarithm.
GapAim aim_between(double low, double high, NoiseStream& draw);

/// In random order.
template <class Item>
std::vector<Item> shuffled(std::span<const Item> items, NoiseStream& draw) {
    std::vector<Item> order(items.begin(), items.end());
    shuffle(order, NoiseStream(draw.bits(), "self-check/order"));
    return order;
}

/// Whether a class can be in one rig with all of others (can_be_together()).
bool can_join(std::string_view class_name, std::span<const std::string_view> others);

}  // namespace fidservo::selfcheck
