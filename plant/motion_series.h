// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's motion under a force by position, as a power series of time; all other forces are linear in
// its velocity:
//
//     y' = v,    v' = a + b f(y) - c v          f: plant/standing_force.h
//
// With u = t / h, the fraction of a duration h, and y = sum Y_n u^n and so on,
//
//     (n + 1) Y_n+1 = h V_n,    (n + 1) V_n+1 = h (a [n = 0] + b F_n - c V_n).
//
// Sine and cosine of an angle A, itself a series, are the series  n S_n = sum j A_j C_n-j, n C_n = -sum j A_j
// S_n-j  over j = 1 .. n  (Moore, Interval Analysis, 1966, ch. 11), and a product of series is their
// convolution. A shorter duration is a smaller u, which needs only the sums again.
#include "plant/standing_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fidservo::plant {

/// The coefficients a, b and c.
struct ForcesOnMotion {
    double constant_mm_per_s2;
    double standing_mm_per_s2_per_V;
    double damping_per_s;
};

class MotionSeries {
  public:
    /// @param sine, cosine  of the wave's angle at the start
    MotionSeries(const ForcesOnMotion& forces, const StandingForce& standing, double sine, double cosine,
                 double position_mm, double velocity_mm_per_s, double duration_s)
        : rad_per_mm_(2.0 * std::numbers::pi / standing.cogging_period_mm), sine_{sine}, cosine_{cosine} {
        place_[0] = position_mm;
        speed_[0] = velocity_mm_per_s;
        off_[0] = position_mm - standing.cable_centre_mm;
        for (std::size_t n = 0; n < order; ++n) {
            const double share = duration_s / static_cast<double>(n + 1);
            const double constant = n == 0 ? forces.constant_mm_per_s2 : 0.0;
            place_[n + 1] = off_[n + 1] = share * speed_[n];
            speed_[n + 1] = share * (constant + forces.standing_mm_per_s2_per_V * force_V(standing, n) -
                                     forces.damping_per_s * speed_[n]);
        }
    }

    /// The largest fraction of the duration, at most 1, at which the truncation error is within both
    /// tolerances.
    double trusted_share(double place_tolerance_mm, double speed_tolerance_mm_per_s) const {
        constexpr double of_next = 0.1;  // factor for the term before, as the last term may be 0 by chance
        const auto in_tolerances = [&](std::size_t n) {
            return std::max(std::abs(place_[n]) / place_tolerance_mm,
                            std::abs(speed_[n]) / speed_tolerance_mm_per_s);
        };
        const double last = std::max(in_tolerances(order), of_next * in_tolerances(order - 1));
        return last <= 1.0 ? 1.0 : std::pow(last, -1.0 / (order - 1));
    }

    /// Position in mm and velocity in mm/s at a fraction of the duration.
    std::array<double, 2> at(double share) const {
        std::array<double, 2> sum{};
        for (std::size_t n = order + 1; n-- > 0;) {
            sum[0] = sum[0] * share + place_[n];
            sum[1] = sum[1] * share + speed_[n];
        }
        return sum;
    }

  private:
    static constexpr std::size_t order = 7;
    using Series = std::array<double, order + 1>;

    static double product(const Series& one, const Series& other, std::size_t n) {
        double sum = 0.0;
        for (std::size_t j = 0; j <= n; ++j) sum += one[j] * other[n - j];
        return sum;
    }

    /// F_n, from the terms up to n of all other series.
    double force_V(const StandingForce& force, std::size_t n) {
        return (force.cogging_V == 0.0 ? 0.0 : wave_V(force, n)) - cable_V(force, n);
    }

    double wave_V(const StandingForce& force, std::size_t n) {
        if (n > 0) {
            way_[n] = static_cast<double>(n) * rad_per_mm_ * place_[n];
            double sine = 0.0, cosine = 0.0;
            for (std::size_t j = 1; j <= n; ++j) {
                sine += way_[j] * cosine_[n - j];
                cosine -= way_[j] * sine_[n - j];
            }
            sine_[n] = sine / static_cast<double>(n);
            cosine_[n] = cosine / static_cast<double>(n);
        }
        const double g = force.cogging_second_sine, h = force.cogging_second_cosine;
        if (g == 0.0 && h == 0.0) return force.cogging_V * sine_[n];
        // sin 2a = 2 s c, cos 2a = 1 - 2 s^2
        second_[n] = 2.0 * (g * cosine_[n] - h * sine_[n]);
        return force.cogging_V * (sine_[n] + product(sine_, second_, n) + (n == 0 ? h : 0.0));
    }

    double cable_V(const StandingForce& force, std::size_t n) {
        if (force.cable_V_per_mm == 0.0) return 0.0;
        if (force.cable_hardening == 0.0) return force.cable_V_per_mm * off_[n];
        square_[n] = force.hardening_per_mm2() * product(off_, off_, n);
        return force.cable_V_per_mm * (off_[n] + product(off_, square_, n));
    }

    double rad_per_mm_;
    Series place_{}, speed_{}, off_{}, square_{}, way_{}, sine_, cosine_, second_{};
};

}  // namespace fidservo::plant
