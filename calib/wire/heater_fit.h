// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's heater from recordings: commands, and what a thermometer or the Hall sensor read.
//
//     phi(c) = gain (c - onset)  for c > onset, else 0;     dT/dt = (phi - (T - Ta)) / tau,
//     tau = heating tau while phi > T - Ta, else cooling tau
//
// Output error: the model is run from each recording's start on its commands alone, through hysteresis and
// Hall curve where the sensor is the Hall sensor, and its readings are fitted to those recorded.
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
/// As rig files name it.
std::string_view name_of(HeaterNumber number);

/// A number that the runs do not determine, and why.
struct HeaterRefusal {
    HeaterNumber number;  ///< which
    std::string reason;   ///< in words
};

/// Two runs that, each by itself, say different things of a number.
struct HeaterContradiction {
    HeaterNumber number;    ///< which number the runs contradict each other about
    double apart;           ///< in standard errors of the difference
    std::size_t low, high;  ///< of the runs
    /// The two runs' values, with standard errors.
    double low_value, low_std, high_value, high_std;
};

/// What is determined of numbers that are not, each by itself.
struct HeaterCombination {
    /// Of the combination, for people; its unit has per V, or per unit of the drive.
    std::string name, unit;
    /// Its value and standard error.
    double value, std;
};

/// A heater as runs tell it.
struct HeaterFit {
    /// Numbers that the data do not determine are those of the model given.
    HeaterParameters heater;
    /// Standard errors in the order of HeaterNumber; NaN for numbers that are not determined. They count
    /// errors correlated over time (calib/batch_variance.h) and runs that differ (calib/heterogeneity.h).
    std::array<double, heater_numbers> std;
    std::array<double, heater_numbers> freedom;  ///< of Student's law for intervals
    std::vector<HeaterRefusal> refused;          ///< what they do not determine
    double residual_rms;                         ///< of the readings that have weight, in their unit
    /// R.m.s. of the residual over that of the readings about their mean, both weighted.
    double missed_share;
    std::vector<HeaterContradiction> contradictions;  ///< where runs contradict each other
    std::vector<HeaterCombination> combinations;      ///< what they determine only together
    std::size_t samples;                              ///< that it was fitted to
};

/// What the Hall sensor shows. The start of the iteration is the heater fitted to the temperature that the
/// inverse hysteresis infers, weighted by what a reading knows of it.
/// @param model  hysteresis, Hall curve, and the heater as it is believed so far
/// Fails with Reason::not_identifiable if the runs are empty, not finite, or move the platform by less than a
/// tenth of its stroke.
Result<HeaterFit> fit_heater(const MicroModel& model, const std::vector<HeaterRun>& runs);

/// What a thermometer shows. The ambient number is what the thermometer reads above the run's measured
/// ambient, or the ambient temperature itself where that was not measured; the first reading is the start
/// unless the run gives one. Fails with Reason::not_identifiable if the runs are empty, not finite, or the
/// temperature or the command does not move.
Result<HeaterFit> fit_heater_to_temperature(const std::vector<HeaterRun>& runs);

/// What the sensor would read under a run's commands.
std::vector<double> predict_hall(const MicroModel& model, const HeaterParameters& heater,
                                 const HeaterRun& run);
/// The temperatures that a run's commands give by the model, degC, sample by sample.
std::vector<double> predict_temperature(const HeaterParameters& heater, const HeaterRun& run);

}  // namespace fidservo::calib
