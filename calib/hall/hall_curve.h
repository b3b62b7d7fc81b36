// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The Hall sensor's curve (core/hall.h) from readings at known displacements.
//
//     V = mid + span s (1 + cubic (1 - s^2)),    s = (x - centre) / half_range
//
// is a general increasing cubic that flattens towards both sides, written about its point of inflection, with
// four parameters. half_range, the distance from the centre at which the voltage differs from mid by the
// span, is a convention and taken from the rig file. The cubic polynomial is fitted, and turned into the four
// numbers: V = p0 + p1 x + p2 x^2 + p3 x^3,
//
//     centre = -p2 / (3 p3),   a = p1 - p2^2 / (3 p3),   span = a h + p3 h^3,   cubic = -p3 h^3 / span
#include "core/hall.h"
#include "core/result.h"

#include <cstddef>
#include <optional>
#include <span>

namespace fidservo::calib {

/// A reading with the displacement by a reference.
struct HallSample {
    double reference_mm;  ///< displacement by the reference
    double adc;           ///< the sensor's reading, LSB
};

/// A fitted curve, with standard errors.
struct HallCurve {
    HallParameters hall;           ///< the curve
    double mid_std_V, span_std_V;  ///< standard errors of the voltages, V
    /// Standard errors of centre and cubic, which are determined only by data over the whole S-shaped curve.
    /// Without such data centre and cubic are those of the nominal curve, and `refused` says why.
    double centre_std_mm, cubic_std;
    std::optional<Failure> refused;  ///< why centre and cubic are nominal; empty if the data determine them
    double residual_lsb;             ///< r.m.s. of reading minus curve
    double low_mm, high_mm;          ///< range of the reference's displacements
    double mean_um_per_bit;          ///< mean over the travel
    double finest_um_per_bit;        ///< where the curve is steepest
    double coarsest_um_per_bit;      ///< where it is flattest
    std::size_t samples;             ///< number of samples to which it was fitted
    std::size_t saturated;           ///< readings at an end of the converter's range, which were left out
};

/// Least squares over the readings; standard errors allow for the residuals' autocorrelation.
/// @param nominal  gives half range and converter, and those parameters that the data do not determine
/// @param travel_low_mm, travel_high_mm  range of displacements, in the frame of the reference, in which the
/// curve will be used
/// @return fails with Reason::not_identifiable if not even mid and span are determined: fewer than 20 usable
/// samples, a range of displacements below a twentieth of the travel, or readings that do not rise with the
/// displacement
Result<HallCurve> fit_hall_curve(const HallParameters& nominal, std::span<const HallSample> samples,
                                 double travel_low_mm, double travel_high_mm);

}  // namespace fidservo::calib
