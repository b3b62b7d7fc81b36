// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/encoder.h"

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr Encoder encoder{0.05};

TEST(Encoder, EndOfTravelOrigin_CountsToTheNearestCount) {
    const EncoderState state = start(encoder, 100.0, EncoderOrigin::end_of_travel);
    EXPECT_EQ(sample(encoder, state, 0.0), 0);
    EXPECT_EQ(sample(encoder, state, 0.0249), 0);
    EXPECT_EQ(sample(encoder, state, 0.0251), 1);
    EXPECT_EQ(sample(encoder, state, -0.0249), 0);
    EXPECT_EQ(sample(encoder, state, -0.0251), -1);
    EXPECT_EQ(sample(encoder, state, 200.0), 4000);
}

TEST(Encoder, PowerUpOrigin_SaysNothingAboutThePosition) {
    for (const double position_mm : {0.0, 3.3, 77.78, 200.0}) {
        const EncoderState state = start(encoder, position_mm, EncoderOrigin::power_up);
        EXPECT_EQ(sample(encoder, state, position_mm), 0);
        EXPECT_EQ(sample(encoder, state, position_mm + 5.0), 100);
        EXPECT_EQ(sample(encoder, state, position_mm - 5.0), -100);
    }
}

}  // namespace
}  // namespace fidservo::plant
