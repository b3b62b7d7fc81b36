// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/loop_statistics.h"

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

TEST(LatenessHistogram, EveryBin_HoldsWhatItsEndsSay) {
    TimeNs begin_ns = 0;
    for (std::size_t bin = 0; bin < LatenessHistogram::fine_bins + LatenessHistogram::coarse_bins; ++bin) {
        const TimeNs end_ns = LatenessHistogram::end_ns(bin);
        EXPECT_EQ(LatenessHistogram::bin_of(begin_ns), bin);
        EXPECT_EQ(LatenessHistogram::bin_of(end_ns - 1), bin);
        begin_ns = end_ns;
    }
    EXPECT_EQ(LatenessHistogram::bin_of(-5), 0U);
    EXPECT_EQ(LatenessHistogram::bin_of(ns_per_s * 3600),
              LatenessHistogram::fine_bins + LatenessHistogram::coarse_bins - 1);
}

TEST(LatenessHistogram, Quantiles_OfAKnownDistribution) {
    LatenessHistogram histogram;
    EXPECT_EQ(histogram.quantile_ns(0.5), 0);
    for (TimeNs late_us = 0; late_us < 100; ++late_us) {
        ++histogram.counts[LatenessHistogram::bin_of(1000 * late_us)];
        histogram.worst_ns = 1000 * late_us;
    }
    EXPECT_EQ(histogram.total(), 100U);
    EXPECT_EQ(histogram.quantile_ns(0.5), 50'000);
    EXPECT_EQ(histogram.quantile_ns(0.99), 99'000);
    EXPECT_EQ(histogram.quantile_ns(1.0), 99'000);  // the worst, not its bin's end
}

}  // namespace
}  // namespace fidservo::control
