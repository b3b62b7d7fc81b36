// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Parameters of a hypothesis in lengths over which they matter, as fits change them.
#include "gap/evidence.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// All parameters of a hypothesis, in order, in scales. A scale is what separates the typical value from the
/// vanishing one; for a shape a share of its typical value or of its range; for the period of a wave what
/// puts it out of step by a radian over the reach of the rail.
class ScaledParameters {
  public:
    explicit ScaledParameters(const Hypothesis& start);

    std::size_t size() const { return all_.size(); }
    double scale(std::size_t k) const { return scales_[k]; }
    double low(std::size_t k) const { return all_[k]->low / scale(k); }
    double high(std::size_t k) const { return all_[k]->high / scale(k); }
    bool at_bound(std::size_t k) const { return values[k] <= low(k) || values[k] >= high(k); }

    /// Whether nothing changes with it there: an effect is without it, or it is a choice.
    bool is_level(std::size_t k) const {
        return all_[k]->is_choice() || all_[k]->is_negligible(values[k] * scale(k));
    }

    /// Whether it says how large an effect is.
    bool is_size(std::size_t k) const { return all_[k]->is_size(); }

    /// Where its effect is without it.
    double vanishing(std::size_t k) const { return all_[k]->vanishing / scale(k); }

    /// Whether two are the same parameter of one effect.
    bool is_same(std::size_t k, const ScaledParameters& others, std::size_t other) const {
        return all_[k] == others.all_[other];
    }

    /// By how many typical sizes a value is from where its effect vanishes; 0 of what is no size.
    double typical_sizes(std::size_t k, double scaled) const {
        return is_size(k) ? scaled - vanishing(k) : 0.0;
    }

    /// A value beyond a bound counts as at it.
    Hypothesis at(std::span<const double> scaled) const;

    std::vector<double> values;

  private:
    Hypothesis hypothesis_;
    std::vector<const plant::EffectParameter*> all_;
    std::vector<double> scales_;
};

}  // namespace fidservo::gap
