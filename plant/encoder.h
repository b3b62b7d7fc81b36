// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage's incremental encoder:  count = floor(y / resolution + 1/2) - origin.
//
// It counts from where the carriage was at power-up, so that before homing a count says nothing about the
// position. Recordings of the reference rig are made after homing, with the origin at the left end of travel
// (origin 0).
#include "plant/formulas/formulas.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace fidservo::plant {

/// A periodic error  A sin(2 pi y / p + phase)  of the position that the encoder reads.
struct EncoderRipple {
    double amplitude_mm = 0.0;
    double period_mm = 1.0;
    double phase_rad = 0.0;

    double rad_per_mm() const { return 2.0 * std::numbers::pi / period_mm; }
};

struct Encoder {
    double resolution_mm;
    EncoderRipple ripple{};
    Formulas formulas{};

    /// Whether the scale is without error: no ripple, no formulas.
    bool is_straight() const { return ripple.amplitude_mm == 0.0 && !formulas.any(); }
};

/// Where the encoder's count is zero.
enum class EncoderOrigin {
    power_up,       ///< where the carriage stands at the start
    end_of_travel,  ///< at y = 0: the rig was homed before
};

struct EncoderState {
    std::int64_t origin_count = 0;
};

EncoderState start(const Encoder& encoder, double position_mm, EncoderOrigin origin);

/// What formulas add to the position that the encoder reads, mm.
inline double formula_error_mm(const Encoder& encoder, double position_mm) {
    return encoder.formulas.any() ? encoder.formulas.value(Port::encoder, std::array{position_mm}, {}) : 0.0;
}

/// The value before rounding to a count, in counts from the left end of travel: (y + ripple + formulas) /
/// resolution.
inline double mean_reading_count(const Encoder& encoder, double position_mm) {
    const EncoderRipple& ripple = encoder.ripple;
    const double error_mm =
        ripple.amplitude_mm == 0.0
            ? 0.0
            : ripple.amplitude_mm * std::sin(ripple.rad_per_mm() * position_mm + ripple.phase_rad);
    return (position_mm + error_mm + formula_error_mm(encoder, position_mm)) / encoder.resolution_mm;
}

/// Derivative of mean_reading_count() by the position.
inline double counts_per_mm(const Encoder& encoder, double position_mm) {
    const EncoderRipple& ripple = encoder.ripple;
    const double error_per_mm = ripple.amplitude_mm == 0.0
                                    ? 0.0
                                    : ripple.amplitude_mm * ripple.rad_per_mm() *
                                          std::cos(ripple.rad_per_mm() * position_mm + ripple.phase_rad);
    if (!encoder.formulas.any()) return (1.0 + error_per_mm) / encoder.resolution_mm;
    constexpr double step_mm = 1e-4;
    const double formula_per_mm = (formula_error_mm(encoder, position_mm + step_mm) -
                                   formula_error_mm(encoder, position_mm - step_mm)) /
                                  (2.0 * step_mm);
    return (1.0 + error_per_mm + formula_per_mm) / encoder.resolution_mm;
}

/// The count at a carriage position in mm.
std::int64_t sample(const Encoder& encoder, const EncoderState& state, double position_mm);

}  // namespace fidservo::plant
