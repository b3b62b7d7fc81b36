// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/lag_scan.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fidservo::imports {
namespace {

TEST(LagScan, CorrelationAtEachLag_IsPearsonsOfWhatIsInCommon) {
    std::mt19937 generator(1);
    std::normal_distribution<double> draw;
    std::vector<double> x(50), y(30);
    for (double& value : x) value = draw(generator);
    for (double& value : y) value = draw(generator);
    const LagScan scan = scan_lags(y, x);
    EXPECT_EQ(scan.first, 15 - 30);
    ASSERT_EQ(scan.correlation.size(), 51u);
    for (std::size_t k = 0; k < scan.correlation.size(); ++k) {
        const std::ptrdiff_t lag = scan.first + static_cast<std::ptrdiff_t>(k);
        double n = 0.0, sx = 0.0, sy = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
        for (std::ptrdiff_t i = 0; i < 30; ++i) {
            if (i + lag < 0 || i + lag >= 50) continue;
            const double a = x[static_cast<std::size_t>(i + lag)], b = y[static_cast<std::size_t>(i)];
            n += 1.0, sx += a, sy += b, xx += a * a, yy += b * b, xy += a * b;
        }
        const double r = (xy - sx * sy / n) / std::sqrt((xx - sx * sx / n) * (yy - sy * sy / n));
        EXPECT_NEAR(scan.correlation[k], r, 1e-12) << lag;
    }
}

TEST(LagPeaks, AreTheMaximaWithHowFarTheyStandOut) {
    const LagScan scan{0, 8, {0.1, 0.5, 0.3, -0.9, 0.2, 0.4, 0.25, 0.35}};
    const auto peaks = peaks_of(scan);
    ASSERT_EQ(peaks.size(), 4u);
    const std::size_t at[] = {3, 1, 5, 7};
    const double prominence[] = {0.9, 0.2, 0.2, 0.1};
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(peaks[k].at, at[k]);
        EXPECT_NEAR(peaks[k].prominence, prominence[k], 1e-12);
    }
    EXPECT_EQ(width_at_half_height(scan, 3), 1u);
    EXPECT_EQ(width_at_half_height(scan, 1), 3u);
}

}  // namespace
}  // namespace fidservo::imports
