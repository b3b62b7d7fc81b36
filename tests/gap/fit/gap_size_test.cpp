// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/gap_size.h"

#include "tests/gap/equal_windows.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// Of a campaign of the carriage alone, all windows of a signal at some square, in what is expected under the
/// truth.
std::vector<double> squares_of(const Evidence& evidence, Signal signal, double times_expected) {
    std::vector<double> squares;
    for (const Window& window : evidence.windows())
        squares.push_back(window.signal == signal ? times_expected * window.expected_square
                                                  : std::numeric_limits<double>::quiet_NaN());
    return squares;
}

TEST(SignalGaps, DiscrepancyIsWhatNoiseDoesNotAccountFor) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses"});
    const std::vector<double> before = squares_of(evidence, Signal::encoder, 1e4),
                              after = squares_of(evidence, Signal::encoder, 25.0);
    const std::vector<SignalGap> gaps = signal_gaps(evidence, before, after);
    ASSERT_EQ(gaps.size(), 1u);
    const SignalGap& encoder = gaps.front();
    EXPECT_NEAR(encoder.before / encoder.after, std::sqrt(1e4 / 25.0), 1e-9);
    // after^2 = expected + discrepancy^2, expected = after^2 / 25
    EXPECT_NEAR(std::pow(encoder.discrepancy, 2), std::pow(encoder.after, 2) * (1.0 - 1.0 / 25.0), 1e-9);
}

TEST(SignalGaps, OfNoise_HasNoDiscrepancy) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses"});
    for (const double times : {0.5, 1.0, 1.2}) {
        const std::vector<double> squares = squares_of(evidence, Signal::encoder, times);
        EXPECT_EQ(signal_gaps(evidence, squares, squares).front().discrepancy, 0.0) << times;
    }
    const std::vector<double> off = squares_of(evidence, Signal::encoder, 1.3);
    EXPECT_GT(signal_gaps(evidence, off, off).front().discrepancy, 0.0);
}

TEST(TypicalFloors, AreNotThoseOfAFewWindowsThatRanAway) {
    const std::vector<Window> windows = testing::equal_windows(100, 10);
    std::vector<double> squares(100, 9.0);
    EXPECT_NEAR(typical_floors(windows, squares)[index_of(Signal::encoder)], 3.0, 1e-9);
    squares[4] = 1e8;
    EXPECT_LT(typical_floors(windows, squares)[index_of(Signal::encoder)], 3.3);
    EXPECT_EQ(typical_floors(windows, squares)[index_of(Signal::hall)], 1.0);
    EXPECT_EQ(typical_floors(windows, std::vector(100, 0.01))[index_of(Signal::encoder)], 1.0);
}

}  // namespace

}  // namespace fidservo
