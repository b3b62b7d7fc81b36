// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

TEST(NoiseStream, SameSeedAndSource_SameDraws_OthersDiffer) {
    NoiseStream a(5, "hall"), b(5, "hall"), other_source(5, "camera"), other_seed(6, "hall");
    const auto draw = a.bits();
    EXPECT_EQ(draw, b.bits());
    EXPECT_NE(draw, other_source.bits());
    EXPECT_NE(draw, other_seed.bits());
}

TEST(NoiseStream, Seek_ContinuesASnapshot) {
    NoiseStream a(5, "hall");
    for (int k = 0; k < 10; ++k) a.normal();
    NoiseStream b(5, "hall");
    b.seek(a.position());
    EXPECT_EQ(a.normal(), b.normal());
}

TEST(NoiseStream, Normal_HasTheMomentsOfTheLaw) {
    NoiseStream noise(11, "moments");
    constexpr int n = 200'000;
    double sum = 0, square = 0, fourth = 0, product = 0, last = 0;
    for (int k = 0; k < n; ++k) {
        const double z = noise.normal();
        sum += z;
        square += z * z;
        fourth += z * z * z * z;
        product += z * last;
        last = z;
    }
    const double sigma = 1.0 / std::sqrt(n);
    EXPECT_NEAR(sum / n, 0.0, 4 * sigma);
    EXPECT_NEAR(square / n, 1.0, 4 * std::sqrt(2.0) * sigma);
    EXPECT_NEAR(fourth / n, 3.0, 4 * std::sqrt(96.0) * sigma);
    EXPECT_NEAR(product / n, 0.0, 4 * sigma);
}

}  // namespace
}  // namespace fidservo
