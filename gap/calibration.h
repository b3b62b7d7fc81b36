#pragma once
// Coefficients of the probability of a name (gap/standing.h).
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -1.0;
inline constexpr std::array calibrated_coefficients{0.6, 0.3, 0.3, 0.3, 0.0, 0.0, 1.0, 1.0};

}  // namespace fidservo::gap
