#include "vision/normal_table.h"

#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

TEST(NormalTable, EveryArgument_AgreesWithTheClosedForm) {
    const NormalTable normal;
    for (double z = -12.0; z <= 12.0; z += 0.00137) {
        const auto [distribution, density] = normal(z);
        EXPECT_NEAR(distribution, 0.5 * std::erfc(-z / std::numbers::sqrt2), 1e-8) << z;
        EXPECT_NEAR(density, std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi), 1e-8) << z;
    }
}

}  // namespace
}  // namespace fidservo::vision
