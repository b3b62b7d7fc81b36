// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/encoder.h"

#include <cmath>

namespace fidservo::plant {

namespace {

std::int64_t count_from_left_end(const Encoder& encoder, double position_mm) {
    return static_cast<std::int64_t>(std::floor(mean_reading_count(encoder, position_mm) + 0.5));
}

}  // namespace

EncoderState start(const Encoder& encoder, double position_mm, EncoderOrigin origin) {
    return {origin == EncoderOrigin::power_up ? count_from_left_end(encoder, position_mm) : 0};
}

std::int64_t sample(const Encoder& encoder, const EncoderState& state, double position_mm) {
    return count_from_left_end(encoder, position_mm) - state.origin_count;
}

}  // namespace fidservo::plant
