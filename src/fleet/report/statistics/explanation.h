// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The explanation of the units' levels by a sum of shares, for each value of the spread tau between units
// (attribution.h).
#include "src/fleet/report/statistics/point.h"

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace fidservo::fleet {

/// The prior distributions of a share's size m: normal with mean 0 and these standard deviations g, floors.
inline constexpr std::array share_laws{1.0, 4.0, 16.0, 64.0};
/// Number of values of the spread tau over which sums replace the integral: 0, and 25 values from 0.05 to 200
/// floors.
inline constexpr std::size_t spread_count = 26;

double spread_at(std::size_t k);
double log_prior_of_spread(std::size_t k);

/// The shares of an explanation: for each a column of zeros and ones, and the prior standard deviation of its
/// size, floors.
struct TakenShares {
    explicit TakenShares(std::size_t units) : columns(static_cast<Eigen::Index>(units), 0) {}

    Eigen::MatrixXd columns;  ///< a row for each unit
    std::vector<double> laws;

    void take(std::span<const std::size_t> units, double law);
};

/// Bayesian least-squares fit of the levels by the shares' columns, for one value of the spread tau.
struct AtSpread {
    Eigen::VectorXd weights;     ///< 1 / (s^2 + tau^2) of each unit
    Eigen::MatrixXd covariance;  ///< of the shares, (X' W X + G^-1)^-1
    Eigen::VectorXd sizes;       ///< of the shares
    Eigen::VectorXd left;        ///< residuals: levels minus shares
    double log_likelihood = 0.0;
};

/// The gain in likelihood by a further column beside those of an explanation. From its weighted sum of
/// squares and its weighted product with the residuals; units are added to the column one by one.
class FurtherColumn {
  public:
    explicit FurtherColumn(Eigen::Index shares) : shared_(Eigen::VectorXd::Zero(shares)) {}

    void add(const AtSpread& at, const TakenShares& taken, std::size_t unit);
    /// Change of the log likelihood by this column, if its size has the prior standard deviation `law`,
    /// floors.
    double log_gain(const AtSpread& at, double law) const;

  private:
    double square_ = 0.0, product_ = 0.0;
    Eigen::VectorXd shared_;
};

/// The log likelihood with a further share, its likelihood averaged over share_laws, and the value of
/// share_laws with the largest likelihood.
struct WithFurther {
    double log_likelihood, law;
};

class Explanation {
  public:
    /// @param levels  of all units; limits must have been replaced by normal distributions (as_normal())
    explicit Explanation(std::span<const Level> levels);

    double log_likelihood() const { return log_likelihood_; }
    /// The likelihood with a further share that a set of units has.
    WithFurther with(std::span<const std::size_t> units) const;
    /// with() for the sets of the first 1, 2, 3, .. of some units.
    std::vector<WithFurther> with_first_of(std::span<const std::size_t> units) const;
    void take(std::span<const std::size_t> units, double law);

    /// Indices of the units, sorted by their residuals at the most likely spread, the largest first.
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
