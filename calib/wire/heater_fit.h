// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's heater from recordings of commands and of the readings of a thermometer or of the Hall sensor.
//
//     phi(c) = gain (c - onset)  for c > onset, else 0;     dT/dt = (phi - (T - Ta)) / tau,
//     tau = heating tau while phi > T - Ta, else cooling tau
//
// Output error: the model is simulated from each recording's start with its commands alone, through
// hysteresis and Hall curve where the sensor is the Hall sensor, and its readings are fitted to those
// recorded.
#include "calib/wire/heater_data.h"
#include "core/result.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::calib {

/// The numbers fitted, in this order.
enum class HeaterNumber {
    onset,        ///< onset_V
    gain,         ///< gain_degC_per_V
    heating_tau,  ///< heating_tau_s
    cooling_tau,  ///< cooling_tau_s
    ambient,      ///< ambient_degC
};
/// How many numbers a heater has.
inline constexpr std::size_t heater_numbers = 5;
/// The parameter's name in rig files.
std::string_view name_of(HeaterNumber number);

/// A parameter that the runs do not determine, and why.
struct HeaterRefusal {
    HeaterNumber number;  ///< the parameter
    std::string reason;   ///< in words
};

/// Two runs that by themselves give contradicting estimates of a parameter.
struct HeaterContradiction {
    HeaterNumber number;    ///< the parameter
    double apart;           ///< the difference in its standard errors
    std::size_t low, high;  ///< indices of the runs with the lowest and the highest value
    /// Those runs' estimates and their standard errors.
    double low_value, low_std, high_value, high_std;
};

/// A combination of parameters that is determined although the single ones are not.
struct HeaterCombination {
    /// What it is, and its unit, which refers to V or to the unit of the drive.
    std::string name, unit;
    /// Its value and standard error.
    double value, std;
};

/// The result of a heater's fit.
struct HeaterFit {
    /// Parameters that the data do not determine have the values of the model given.
    HeaterParameters heater;
    /// Standard errors in the order of HeaterNumber; NaN for parameters that are not determined. They include
    /// errors correlated over time (calib/batch_variance.h) and differences between runs
    /// (calib/heterogeneity.h).
    std::array<double, heater_numbers> std;
    /// Degrees of freedom of Student's distribution for intervals.
    std::array<double, heater_numbers> freedom;
    std::vector<HeaterRefusal> refused;  ///< parameters that are not determined
    double residual_rms;  ///< r.m.s. of the residuals with non-zero weight, in the readings' unit
    /// R.m.s. of the residuals over that of the readings about their mean, both weighted.
    double missed_share;
    std::vector<HeaterContradiction> contradictions;  ///< parameters on which runs contradict each other
    std::vector<HeaterCombination> combinations;      ///< determined combinations of undetermined parameters
    std::size_t samples;                              ///< number of samples to which it was fitted
};

/// Fits the heater to readings of the Hall sensor. The iteration starts with the heater fitted to the
/// temperature that the inverse hysteresis gives, weighted by each reading's sensitivity to it.
/// @param model  hysteresis, Hall curve, and the present model of the heater
/// Fails with Reason::not_identifiable if the runs are empty, not finite, or move the platform by less than a
/// tenth of its stroke.
Result<HeaterFit> fit_heater(const MicroModel& model, const std::vector<HeaterRun>& runs);

/// Fits the heater to readings of a thermometer. The parameter `ambient` then is the thermometer's excess
/// over the run's measured ambient temperature, or the ambient temperature itself where none was measured;
/// the first reading is the start temperature unless the run states one. Fails with Reason::not_identifiable
/// if the runs are empty, not finite, or the temperature or the command is constant.
Result<HeaterFit> fit_heater_to_temperature(const std::vector<HeaterRun>& runs);

/// The Hall sensor's readings under a run's commands, by the model.
std::vector<double> predict_hall(const MicroModel& model, const HeaterParameters& heater,
                                 const HeaterRun& run);
/// The temperatures under a run's commands by the model, degC, for each sample.
std::vector<double> predict_temperature(const HeaterParameters& heater, const HeaterRun& run);

}  // namespace fidservo::calib
