#include "plant/encoder.h"

#include <cmath>
#include <numbers>

namespace fidservo::plant {

namespace {

double ripple_mm(const EncoderRipple& ripple, double position_mm) {
    if (ripple.amplitude_mm == 0.0) return 0.0;
    return ripple.amplitude_mm *
           std::sin(2.0 * std::numbers::pi * position_mm / ripple.period_mm + ripple.phase_rad);
}

std::int64_t count_from_left_end(const Encoder& encoder, double position_mm) {
    return static_cast<std::int64_t>(std::floor(mean_reading_count(encoder, position_mm) + 0.5));
}

}  // namespace

double mean_reading_count(const Encoder& encoder, double position_mm) {
    return (position_mm + ripple_mm(encoder.ripple, position_mm)) / encoder.resolution_mm;
}

EncoderState start(const Encoder& encoder, double position_mm, EncoderOrigin origin) {
    return {origin == EncoderOrigin::power_up ? count_from_left_end(encoder, position_mm) : 0};
}

std::int64_t sample(const Encoder& encoder, const EncoderState& state, double position_mm) {
    return count_from_left_end(encoder, position_mm) - state.origin_count;
}

}  // namespace fidservo::plant
