// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether recordings agree on a number, and how much further off it can be where they do not.
#include <cstddef>
#include <span>

namespace fidservo::calib {

/// What one recording alone says.
struct RecordingEstimate {
    double value;
    double std;      ///< positive
    double freedom;  ///< degrees of freedom of the standard error
};

/// Over k recordings with weights w = 1/std^2 and their weighted mean m.
struct Heterogeneity {
    std::size_t recordings;  ///< k
    double q;                ///< Cochran's Q = sum w (value - m)^2
    /// Of a Q as large if all recordings have one value in common: Welch's test, which takes into account
    /// that the weights are estimates; 1 for fewer than two recordings.
    double probability;
    double between_std;  ///< of the recordings' own values about their mean, DerSimonian and Laird
    /// What they add to the variance of an estimate from all the data: between_std^2 sum (w / sum w)^2.
    double added_variance;
    double added_freedom;  ///< its degrees of freedom, k - 1
    /// Mean with weights 1 / (std^2 + between_std^2), and its variance by the scatter about it (Hartung, An
    /// alternative method for meta-analysis, Biometrical Journal 41(8), 1999), at least by the weights; its
    /// degrees of freedom are k - 1.
    double mean, mean_variance;
    std::size_t low, high;  ///< of the recordings, the two that are farthest apart
    double apart;           ///< their distance in standard errors of the difference
};

/// Cochran, The combination of estimates from different experiments, Biometrics 10(1), 1954; Welch, On the
/// comparison of several mean values, Biometrika 38, 1951, of which Student's test of two means with unequal
/// variances is the case k = 2; DerSimonian, Laird, Meta-analysis in clinical trials, Controlled Clinical
/// Trials 7(3), 1986.
Heterogeneity heterogeneity(std::span<const RecordingEstimate> recordings);

/// Sum of independent contributions to a variance, with Satterthwaite's degrees of freedom.
struct VarianceSum {
    double variance = 0.0;
    double freedom = 0.0;

    /// @param freedom_of_it  may be infinite
    void add(double variance_of_it, double freedom_of_it);

  private:
    double weighted_ = 0.0;  ///< sum of variance^2 / freedom
};

}  // namespace fidservo::calib
