// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether stated uncertainties describe the errors: over many independent trials the normalised squared
// errors follow a chi-square distribution.
#include "core/failure.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::vision::testing {

class Consistency {
  public:
    void add(const Measured& measured, double truth) {
        const double error = measured.value - truth;
        ++trials_;
        sum_ += error;
        chi2_ += std::pow(error / measured.std, 2);
    }

    int trials() const { return trials_; }
    double bias() const { return sum_ / trials_; }
    double chi2() const { return chi2_; }

    /// Quantile of the chi-square law (Wilson and Hilferty 1931).
    double quantile(double z) const {
        const double c = 2.0 / (9.0 * trials_);
        return trials_ * std::pow(1.0 - c + z * std::sqrt(c), 3);
    }

  private:
    int trials_ = 0;
    double sum_ = 0.0;
    double chi2_ = 0.0;
};

/// The bias is below `most_bias`, and the squared errors lie within the 99 % interval of their distribution.
inline void expect_consistent(const Consistency& trials, double most_bias, const char* what) {
    constexpr double two_sided_99 = 2.576;
    ASSERT_GE(trials.trials(), 100) << what;
    EXPECT_LT(std::abs(trials.bias()), most_bias) << what;
    EXPECT_GT(trials.chi2(), trials.quantile(-two_sided_99)) << what << ": the uncertainty is overstated";
    EXPECT_LT(trials.chi2(), trials.quantile(two_sided_99)) << what << ": the uncertainty is understated";
}

/// Fails with this reason.
template <class T>
::testing::AssertionResult fails_with(const Result<T>& result, Reason reason) {
    if (result) return ::testing::AssertionFailure() << "gave a value";
    if (result.error().reason != reason)
        return ::testing::AssertionFailure() << name_of(result.error().reason) << ": " << result.error().text;
    return ::testing::AssertionSuccess() << result.error().text;
}

}  // namespace fidservo::vision::testing
