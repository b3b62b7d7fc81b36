// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Forces by position, which act on a carriage at rest too, in volts to the right. They add to the drive's
// voltage before the dead zone, so that friction holds against them while the carriage stands.
//
//     f(y) = A (sin a + g sin 2a + h cos 2a) - k d (1 + c (d / 100 mm)^2),   a = 2 pi y / p + phase,  d = y -
//     y0
//
// The first term is cogging, with a second harmonic; the second one is the spring of the cable harness, which
// may harden (Duffing).
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace fidservo::plant {

struct StandingForce {
    double cogging_V = 0.0;
    double cogging_period_mm = 1.0;
    double cogging_phase_rad = 0.0;
    double cogging_second_sine = 0.0, cogging_second_cosine = 0.0;  ///< g, h
    double cable_V_per_mm = 0.0;
    double cable_centre_mm = 0.0;
    double cable_hardening = 0.0;  ///< c

    double hardening_per_mm2() const { return 1e-4 * cable_hardening; }
};

inline bool acts(const StandingForce& force) {
    return force.cogging_V != 0.0 || force.cable_V_per_mm != 0.0;
}

/// Whether the force is a linear function of the position.
inline bool is_straight(const StandingForce& force) {
    return force.cogging_V == 0.0 && force.cable_hardening == 0.0;
}

/// f(y) in V, to the right, for positions that follow each other closely: near a position whose sine and
/// cosine are known those of another one follow from a few terms of their series.
class StandingForceNearby {
  public:
    explicit StandingForceNearby(const StandingForce& force)
        : force_(force), rad_per_mm_(2.0 * std::numbers::pi / force.cogging_period_mm) {}

    /// Announces that positions near this one are asked for next.
    void go_to(double position_mm) {
        if (force_.cogging_V == 0.0 || std::abs(rad_per_mm_ * (position_mm - here_mm_)) <= near_rad) return;
        here_mm_ = position_mm;
        sine_ = std::sin(phase_rad(position_mm));
        cosine_ = std::cos(phase_rad(position_mm));
    }

    double volts(double position_mm) const {
        const double off_mm = position_mm - force_.cable_centre_mm;
        const double cable_V =
            -force_.cable_V_per_mm * off_mm * (1.0 + force_.hardening_per_mm2() * off_mm * off_mm);
        return force_.cogging_V == 0.0 ? cable_V : cable_V + force_.cogging_V * wave(position_mm);
    }

    /// Sine and cosine of the cogging wave's angle a.
    std::pair<double, double> sine_and_cosine(double position_mm) const {
        const double on_rad = rad_per_mm_ * (position_mm - here_mm_);
        if (!(std::abs(on_rad) <= near_rad))
            return {std::sin(phase_rad(position_mm)), std::cos(phase_rad(position_mm))};
        if (on_rad == 0.0) return {sine_, cosine_};
        // Their Taylor series, by Horner's scheme; the truncation error is below 1e-17.
        constexpr std::array sine_terms{-1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6, 1.0};
        constexpr std::array cosine_terms{1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720,
                                          1.0 / 24,        -1.0 / 2,       1.0};
        const auto series = [square = on_rad * on_rad](const auto& terms) {
            double sum = 0.0;
            for (const double term : terms) sum = sum * square + term;
            return sum;
        };
        const double sine_on = on_rad * series(sine_terms), cosine_on = series(cosine_terms);
        return {sine_ * cosine_on + cosine_ * sine_on, cosine_ * cosine_on - sine_ * sine_on};
    }

  private:
    static constexpr double near_rad = 0.25;

    double phase_rad(double position_mm) const {
        return rad_per_mm_ * position_mm + force_.cogging_phase_rad;
    }

    double wave(double position_mm) const {
        const auto [sine, cosine] = sine_and_cosine(position_mm);
        const double g = force_.cogging_second_sine, h = force_.cogging_second_cosine;
        return g == 0.0 && h == 0.0 ? sine : sine + 2.0 * g * sine * cosine + h * (1.0 - 2.0 * sine * sine);
    }

    const StandingForce& force_;
    double rad_per_mm_;
    double here_mm_ = std::numeric_limits<double>::infinity();
    double sine_ = 0.0, cosine_ = 0.0;
};

}  // namespace fidservo::plant
