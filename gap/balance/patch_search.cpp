// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/patch_search.h"

#include "gap/balance/carriage_forces.h"
#include "gap/balance/period_search.h"
#include "gap/balance/rail_stretch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

using Force = std::function<double(const SlidingRow&)>;

/// Forces that know no place: a constant, Coulomb and viscous friction.
constexpr Eigen::Index placeless = 3;

/// Lacking forces of all supports with a bell's beside the placeless ones, windows weighted.
class PatchFit {
  public:
    explicit PatchFit(const CarriageForces& forces) : forces_(forces) {
        const auto count = static_cast<Eigen::Index>(forces.supports().size());
        const std::vector<double> weights = support_weights(forces.windows(), forces.lacking());
        weights_ = Eigen::Map<const Eigen::VectorXd>(weights.data(), count);
        lacking_ = weighted(forces.lacking());
        placeless_.resize(count, placeless);
        placeless_.col(0) = weighted([](const SlidingRow& row) { return row.passed; });
        placeless_.col(1) = weighted([](const SlidingRow& row) { return row.direction; });
        placeless_.col(2) = weighted([](const SlidingRow& row) { return row.velocity_mm_per_s; });
        solver_.compute(placeless_);
        lacking_ -= placeless_ * solver_.solve(lacking_);
    }

    FrictionPatch at(double centre_mm, double width_mm) const {
        Eigen::VectorXd bell = weighted([&](const SlidingRow& row) {
            const double widths = (row.position_mm - centre_mm) / width_mm;
            return row.direction * std::exp(-0.5 * widths * widths);
        });
        bell -= placeless_ * solver_.solve(bell);
        const double product = bell.dot(lacking_), square = bell.squaredNorm();
        if (product <= 0.0) return {0.0, centre_mm, width_mm, 0.0};
        return {product / square, centre_mm, width_mm, product * product / (square * lacking_.squaredNorm())};
    }

  private:
    /// What supports show where the truth has a force that the prediction lacks.
    Eigen::VectorXd weighted(const Force& force_V) const {
        return weighted(forces_.of_force(0, force_V).values);
    }

    /// @param values  one for each support
    Eigen::VectorXd weighted(const std::vector<float>& values) const {
        return weights_.cwiseProduct(
            Eigen::Map<const Eigen::VectorXf>(values.data(), weights_.size()).cast<double>());
    }

    const CarriageForces& forces_;
    Eigen::VectorXd lacking_, weights_;
    Eigen::MatrixXd placeless_;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver_;
};

/// The strongest, none within two widths of a stronger one.
std::vector<FrictionPatch> apart(std::vector<FrictionPatch> all) {
    std::ranges::sort(all, std::greater{}, &FrictionPatch::share);
    std::vector<FrictionPatch> chosen;
    for (const FrictionPatch& patch : all) {
        const bool is_beside = std::ranges::any_of(chosen, [&](const FrictionPatch& other) {
            return std::abs(patch.centre_mm - other.centre_mm) <
                   2.0 * std::max(patch.width_mm, other.width_mm);
        });
        if (patch.share > 0.0 && !is_beside && chosen.size() < most_peaks) chosen.push_back(patch);
    }
    return chosen;
}

}  // namespace

std::vector<FrictionPatch> strongest_patches(const Evidence& evidence, const Errors& errors) {
    constexpr std::array widths_mm{1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
    const CarriageForces forces(evidence, errors, short_half_support);
    if (forces.supports().size() <= static_cast<std::size_t>(placeless)) return {};
    const RailStretch places = most_visited(forces.rows());
    const PatchFit fit(forces);
    std::vector<FrictionPatch> all;
    for (const double width_mm : widths_mm)
        for (double centre_mm = places.low_mm; centre_mm <= places.high_mm; centre_mm += width_mm) {
            evidence.budget()->check();
            all.push_back(fit.at(centre_mm, width_mm));
        }
    return apart(std::move(all));
}

}  // namespace fidservo::gap
