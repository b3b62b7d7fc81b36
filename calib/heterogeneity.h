// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tests whether recordings agree on a number, and estimates by how much its uncertainty increases if they do
// not.
#include <cstddef>
#include <span>

namespace fidservo::calib {

/// The estimate from one recording alone.
struct RecordingEstimate {
    double value;
    double std;      ///< positive
    double freedom;  ///< degrees of freedom of the standard error
};

/// The heterogeneity of k recordings with weights w = 1/std^2 and weighted mean m.
struct Heterogeneity {
    std::size_t recordings;  ///< k
    double q;                ///< Cochran's Q = sum w (value - m)^2
    /// p-value: probability of a Q at least as large if all recordings had the same true value. Welch's test,
    /// which allows for estimated weights; 1 for fewer than two recordings.
    double probability;
    /// Standard deviation of the recordings' true values about their mean (DerSimonian and Laird).
    double between_std;
    /// The variance that between_std adds to an estimate from all the data: between_std^2 sum (w / sum w)^2.
    double added_variance;
    double added_freedom;  ///< degrees of freedom of added_variance, k - 1
    /// Mean with weights 1 / (std^2 + between_std^2), and its variance from the scatter about it (Hartung, An
    /// alternative method for meta-analysis, Biometrical Journal 41(8), 1999), but no less than by the
    /// weights; k - 1 degrees of freedom.
    double mean, mean_variance;
    std::size_t low, high;  ///< indices of the two recordings that are farthest apart
    double apart;           ///< difference of those two, divided by its standard error
};

/// Computes all fields. Sources: Cochran, The combination of estimates from different experiments, Biometrics
/// 10(1), 1954; Welch, On the comparison of several mean values, Biometrika 38, 1951, of which Student's test
/// of two means with unequal variances is the case k = 2; DerSimonian, Laird, Meta-analysis in clinical
/// trials, Controlled Clinical Trials 7(3), 1986.
Heterogeneity heterogeneity(std::span<const RecordingEstimate> recordings);

/// Sum of independent contributions to a variance, with degrees of freedom by Satterthwaite.
struct VarianceSum {
    double variance = 0.0;
    double freedom = 0.0;

    /// @param freedom_of_it  its degrees of freedom; may be infinite
    void add(double variance_of_it, double freedom_of_it);

  private:
    double weighted_ = 0.0;  ///< sum of variance^2 / freedom
};

}  // namespace fidservo::calib
