// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation of units' levels by shares, at each spread (attribution.h).
#include "src/fleet/report/statistics/point.h"

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace fidservo::fleet {

/// The laws of a share's size: standard deviations, floors.
inline constexpr std::array share_laws{1.0, 4.0, 16.0, 64.0};
/// Spreads over which sums are taken instead of integrals: 0, and 0.05 to 200 floors.
inline constexpr std::size_t spread_count = 26;

double spread_at(std::size_t k);
double log_prior_of_spread(std::size_t k);

/// Shares that were taken in: a column of zeros and ones each, and the law of its size.
struct TakenShares {
    explicit TakenShares(std::size_t units) : columns(static_cast<Eigen::Index>(units), 0) {}

    Eigen::MatrixXd columns;  ///< a row for each unit
    std::vector<double> laws;

    void take(std::span<const std::size_t> units, double law);
};

/// Bayesian least squares of the levels by the shares' columns, at one spread.
struct AtSpread {
    Eigen::VectorXd weights;     ///< 1 / (s^2 + tau^2) of each unit
    Eigen::MatrixXd covariance;  ///< of the shares, (X' W X + G^-1)^-1
    Eigen::VectorXd sizes;       ///< of the shares
    Eigen::VectorXd left;        ///< levels less the shares
    double log_likelihood = 0.0;
};

/// Of a further column beside those taken: its own weighted square, and its product with what is left. Units
/// are added one by one.
class FurtherColumn {
  public:
    explicit FurtherColumn(Eigen::Index shares) : shared_(Eigen::VectorXd::Zero(shares)) {}

    void add(const AtSpread& at, const TakenShares& taken, std::size_t unit);
    /// What it changes the log likelihood by, with the law of its size.
    double log_gain(const AtSpread& at, double law) const;

  private:
    double square_ = 0.0, product_ = 0.0;
    Eigen::VectorXd shared_;
};

/// A log likelihood, averaged over the laws of a further share's size, and the law under which it is
/// likeliest.
struct WithFurther {
    double log_likelihood, law;
};

class Explanation {
  public:
    /// @param levels  those that are not named as normal laws (as_normal())
    explicit Explanation(std::span<const Level> levels);

    double log_likelihood() const { return log_likelihood_; }
    /// With a further share of a set of units.
    WithFurther with(std::span<const std::size_t> units) const;
    /// With a further share of the first 1, 2, 3, .. of some units.
    std::vector<WithFurther> with_first_of(std::span<const std::size_t> units) const;
    void take(std::span<const std::size_t> units, double law);

    /// Units by what the shares leave of their levels, at the likeliest spread, the largest first.
    std::vector<std::size_t> by_what_is_left() const;

  private:
    /// The log likelihood by law and spread.
    using Terms = std::array<std::array<double, spread_count>, share_laws.size()>;
    void fit();
    WithFurther averaged(const Terms& terms) const;

    std::span<const Level> levels_;
    TakenShares taken_;
    std::vector<AtSpread> at_;
    double log_likelihood_ = 0.0;
};

}  // namespace fidservo::fleet
