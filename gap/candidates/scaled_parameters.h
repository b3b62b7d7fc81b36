// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parameters of a hypothesis in scales suitable for fits.
#include "gap/evidence.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// All parameters of a hypothesis, in order, scaled. The scale of a size is the difference between its
/// typical and its vanishing value; that of a shape a fraction of its typical value or of its range; that of
/// a wave's period the change that makes a phase difference of one radian over the length of the rail.
class ScaledParameters {
  public:
    explicit ScaledParameters(const Hypothesis& start);

    std::size_t size() const { return all_.size(); }
    double scale(std::size_t k) const { return scales_[k]; }
    double low(std::size_t k) const { return all_[k]->low / scale(k); }
    double high(std::size_t k) const { return all_[k]->high / scale(k); }
    bool at_bound(std::size_t k) const { return values[k] <= low(k) || values[k] >= high(k); }

    /// Whether the loss does not depend on the parameter locally: an optional one that is negligible, or a
    /// choice.
    bool is_level(std::size_t k) const {
        return all_[k]->is_choice() || all_[k]->is_negligible(values[k] * scale(k));
    }

    /// Whether the parameter is of an effect that moves the carriage or changes its reading.
    bool moves_carriage(std::size_t k) const { return moves_carriage_[k]; }

    /// Whether the parameter is a size.
    bool is_size(std::size_t k) const { return all_[k]->is_size(); }

    /// The distance from the vanishing value in typical sizes; 0 for parameters that are no sizes.
    double typical_sizes(std::size_t k, double scaled) const {
        return is_size(k) ? scaled - all_[k]->vanishing / scale(k) : 0.0;
    }

    /// The hypothesis with these values; values beyond a bound are set to it.
    Hypothesis at(std::span<const double> scaled) const;

    std::vector<double> values;

  private:
    Hypothesis hypothesis_;
    std::vector<const plant::EffectParameter*> all_;
    std::vector<double> scales_;
    std::vector<bool> moves_carriage_;
};

}  // namespace fidservo::gap
