#pragma once
// The wire's heater from recordings: commands, and what a thermometer or the Hall sensor read.
//
//     phi(c) = gain (c - onset)  for c > onset, else 0;     dT/dt = (phi - (T - Ta)) / tau,
//     tau = heating tau while phi > T - Ta, else cooling tau
//
// Output error: the model is run from each recording's start on its commands alone, through hysteresis and
// Hall curve where the sensor is the Hall sensor, and its readings are fitted to those recorded.
#include "calib/actuator/heater_data.h"
#include "core/result.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::calib {

/// The numbers fitted, in this order.
enum class HeaterNumber { onset, gain, heating_tau, cooling_tau, ambient };
inline constexpr std::size_t heater_numbers = 5;
std::string_view name_of(HeaterNumber number);

struct HeaterRefusal {
    HeaterNumber number;
    std::string reason;
};

/// Two runs that, each by itself, say different things of a number.
struct HeaterContradiction {
    HeaterNumber number;
    double apart;           ///< in standard errors of the difference
    std::size_t low, high;  ///< of the runs
    double low_value, low_std, high_value, high_std;
};

/// What is determined of numbers that are not, each by itself.
struct HeaterCombination {
    std::string name, unit;  ///< per V, or per unit of the drive
    double value, std;
};

struct HeaterFit {
    /// Numbers that the data do not determine are those of the model given.
    HeaterParameters heater;
    /// Standard errors in the order of HeaterNumber; NaN for numbers that are not determined. They count
    /// errors correlated over time (calib/batch_variance.h) and runs that differ (calib/heterogeneity.h).
    std::array<double, heater_numbers> std;
    std::array<double, heater_numbers> freedom;  ///< of Student's law for intervals
    std::vector<HeaterRefusal> refused;
    double residual_rms;  ///< of the readings that have weight, in their unit
    /// R.m.s. of the residual over that of the readings about their mean, both weighted.
    double missed_share;
    std::vector<HeaterContradiction> contradictions;
    std::vector<HeaterCombination> combinations;
    std::size_t samples;
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
std::vector<double> predict_temperature(const HeaterParameters& heater, const HeaterRun& run);

}  // namespace fidservo::calib
