// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The profile of a blurred edge and its derivatives, eight places at a time.
//
// An edge at distance z (in standard deviations s of the blur) seen through a normal blur is f0 = Phi(z).
// With
//
//     f1 = phi,  f2 = -z phi,  f3 = (z^2 - 1) phi,  f4 = -(z^3 - 3 z) phi,  f5 = (z^4 - 6 z^2 + 3) phi
//
// f_n is the n-th derivative. d f0 / d ln s = f2; f3 is a skew of the profile, f4 a tail; a square pixel's
// area enters by its variance 1/12 px^2 in s and by its fourth cumulant in the factor of f4. Motion during
// the exposure averages all of them over a stretch 2h of z:  f_n -> (f_(n-1)(z + h) - f_(n-1)(z - h)) / 2h,
// with f_(-1) = z Phi(z) + phi(z).
// Source of the series: Cramer, Mathematical Methods of Statistics, 1946, ch. 17.
#include "vision/tags/lanes.h"

namespace fidservo::vision {

struct EdgeProfile {
    Lanes f0, f1, f2, f3, f4, f5;
};

/// The profile without motion; f0 to 1e-7 (Abramowitz and Stegun, Handbook of Mathematical Functions,
/// 26.2.17).
[[gnu::always_inline]] inline void still_profile(const Lanes& z, EdgeProfile& f) {
    constexpr float inverse_root_two_pi = 0.39894228F;
    const Lanes far = z < 0.0F ? -z : z;
    const Lanes t = 1.0F / (1.0F + 0.2316419F * far);
    Lanes density;
    exp_of_negative(-0.5F * z * z, density);
    density *= inverse_root_two_pi;
    const Lanes tail =
        density * t *
        (0.319381530F + t * (-0.356563782F + t * (1.781477937F + t * (-1.821255978F + t * 1.330274429F))));
    const Lanes z2 = z * z;
    f.f0 = z < 0.0F ? tail : 1.0F - tail;
    f.f1 = density;
    f.f2 = -z * density;
    f.f3 = (z2 - 1.0F) * density;
    f.f4 = -z * (z2 - 3.0F) * density;
    f.f5 = (z2 * (z2 - 6.0F) + 3.0F) * density;
}

/// The profile averaged over z - half .. z + half, half > 0.
[[gnu::always_inline]] inline void moving_profile(const Lanes& z, float half, EdgeProfile& f) {
    const Lanes low = z - half, high = z + half;
    EdgeProfile a, b;
    still_profile(high, a);
    still_profile(low, b);
    const float by_stretch = 0.5F / half;
    f.f0 = by_stretch * (high * a.f0 + a.f1 - low * b.f0 - b.f1);
    f.f1 = by_stretch * (a.f0 - b.f0);
    f.f2 = by_stretch * (a.f1 - b.f1);
    f.f3 = by_stretch * (a.f2 - b.f2);
    f.f4 = by_stretch * (a.f3 - b.f3);
    f.f5 = by_stretch * (a.f4 - b.f4);
}

/// The profile with or without motion.
/// @param half  half the motion's length in units of z; 0: no motion
[[gnu::always_inline]] inline void profile_at(const Lanes& z, float half, EdgeProfile& f) {
    if (half > 0.0F)
        moving_profile(z, half, f);
    else
        still_profile(z, f);
}

}  // namespace fidservo::vision
