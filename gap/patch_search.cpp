#include "gap/patch_search.h"

#include "gap/carriage_forces.h"

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
    PatchFit(const Evidence& evidence, const CarriageForces& forces) : forces_(forces) {
        const auto count = static_cast<Eigen::Index>(forces.supports().size());
        lacking_.resize(count);
        weights_.resize(count);
        find_weights(evidence);
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
    void find_weights(const Evidence& evidence) {
        const std::vector<CarriageForces::Support>& supports = forces_.supports();
        std::size_t w = 0, begin = 0;
        for (std::size_t k = 0; k <= supports.size(); ++k) {
            if (k < supports.size() && supports[k].slot < evidence.windows()[w].end) continue;
            double squares = 0.0;
            for (std::size_t i = begin; i < k; ++i) squares += square(forces_.lacking()[supports[i].slot]);
            const double weight = 1.0 / std::sqrt(static_cast<double>(k - begin) + squares);
            for (std::size_t i = begin; i < k; ++i) {
                const auto at = static_cast<Eigen::Index>(i);
                weights_(at) = weight;
                lacking_(at) = weight * static_cast<double>(forces_.lacking()[supports[i].slot]);
            }
            begin = k;
            while (k < supports.size() && supports[k].slot >= evidence.windows()[w].end) ++w;
        }
    }
    static double square(double value) { return value * value; }

    /// What supports show where the truth has a force that the prediction lacks.
    Eigen::VectorXd weighted(const Force& force_V) const {
        const Column column = forces_.of_force(0, [&](const SlidingRow& row) { return force_V(row); });
        Eigen::VectorXd values(weights_.size());
        for (Eigen::Index k = 0; k < values.size(); ++k)
            values(k) = weights_(k) * column.values[forces_.supports()[static_cast<std::size_t>(k)].slot];
        return values;
    }

    const CarriageForces& forces_;
    Eigen::VectorXd lacking_, weights_;
    Eigen::MatrixXd placeless_;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver_;
};

/// The strongest, none within two widths of a stronger one.
std::vector<FrictionPatch> apart(std::vector<FrictionPatch> all) {
    constexpr std::size_t most = 4;
    std::ranges::sort(all, std::greater{}, &FrictionPatch::share);
    std::vector<FrictionPatch> chosen;
    for (const FrictionPatch& patch : all) {
        const bool is_beside = std::ranges::any_of(chosen, [&](const FrictionPatch& other) {
            return std::abs(patch.centre_mm - other.centre_mm) <
                   2.0 * std::max(patch.width_mm, other.width_mm);
        });
        if (patch.share > 0.0 && !is_beside && chosen.size() < most) chosen.push_back(patch);
    }
    return chosen;
}

}  // namespace

std::vector<FrictionPatch> strongest_patches(const Evidence& evidence, const Errors& errors) {
    constexpr std::array widths_mm{1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
    const CarriageForces forces(evidence, errors, short_half_support);
    if (forces.supports().size() <= static_cast<std::size_t>(placeless)) return {};
    const auto [low, high] = std::ranges::minmax_element(forces.rows(), {}, &SlidingRow::position_mm);
    const PatchFit fit(evidence, forces);
    std::vector<FrictionPatch> all;
    for (const double width_mm : widths_mm)
        for (double centre_mm = low->position_mm; centre_mm <= high->position_mm; centre_mm += width_mm)
            all.push_back(fit.at(centre_mm, width_mm));
    return apart(std::move(all));
}

}  // namespace fidservo::gap
