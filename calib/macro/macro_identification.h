// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Identification of the macro stage from recordings: gain, time constant, dead zone, friction and offset,
// each with its standard error, or with the reason why the data do not determine it.
#include "calib/macro/macro_motion.h"
#include "calib/macro/macro_trace.h"
#include "core/macro_parameters.h"
#include "core/result.h"

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fidservo::calib {

/// Prior knowledge of the rig: how it is built, not its dynamics.
struct MacroBuild {
    double resolution_mm;    ///< resolution of the encoder
    Travel travel;           ///< in the encoder's frame; infinite where the encoder's origin is unknown
    double command_limit_V;  ///< larger recorded commands are clipped to this
    bool dead_zone;          ///< whether friction is modelled as a dead zone on the command
    double unit_V;           ///< the command at which the effective voltage is 1 V, which defines the gain
    double threshold_V;  ///< the rig file's threshold, for a0 where the data leave the threshold undetermined
};

/// From a rig file. unit_V is the command whose effective voltage behind the dead zone is 1 V: 4 V on the
/// reference rig, (1 - a0) / delta above the threshold.
MacroBuild macro_build(const MacroParameters& macro);

/// A number with its standard error.
struct MacroEstimate {
    double value;  ///< in the unit that its name states
    double std;    ///< one standard error
    /// Degrees of freedom of Student's distribution for intervals.
    double freedom = std::numeric_limits<double>::infinity();

    /// Bound of the additional error from forces that the model lacks, if the residual in excess of noise
    /// were entirely an error in the direction of this figure (Cauchy-Schwarz inequality). 0 if there is no
    /// such residual.
    double systematic = 0.0;

    /// Half the width of the 95 % confidence interval.
    double reach_95() const;
};

/// Two recordings whose estimates of a figure contradict each other.
struct MacroContradiction {
    std::string figure;  ///< "gain", "time constant", ...
    double apart;        ///< difference of the two values, divided by its standard error
    /// The recordings with the lowest and with the highest value.
    std::string low_recording, high_recording;
    /// The estimates from these recordings.
    MacroEstimate low, high;
};

/// A force that the recordings show and the model does not have.
struct MacroMissing {
    std::string depends_on;  ///< what the force depends on: position, speed, ...
    double share;            ///< fraction of the residual's sum of squares that it explains
};

/// The result. Each figure is either determined or refused (Reason::not_identifiable).
struct MacroIdentification {
    Result<MacroEstimate> gain_mm_per_s_per_V;  ///< K: speed per effective volt, 1 V at unit_V
    Result<MacroEstimate> time_constant_s;      ///< tau
    Result<MacroEstimate> threshold_V;          ///< the smallest command that moves the carriage
    Result<MacroEstimate> zone_offset_V;        ///< a0: effective voltage at the threshold, eq. (7)
    Result<MacroEstimate> zone_slope;           ///< delta, eq. (7)
    Result<MacroEstimate> friction_V;           ///< Coulomb friction in effective volts
    Result<MacroEstimate> drive_offset_V;       ///< constant force on the carriage, as an equivalent command
    /// a0 holds for the rig file's threshold, as the data did not determine one.
    bool threshold_assumed = false;
    bool friction_at_bound = false;  ///< friction was estimated at its lower bound of 0

    /// Where gain and time constant cannot be separated: their ratio, the acceleration per volt.
    std::optional<MacroEstimate> acceleration_mm_per_s2_per_V;
    std::vector<MacroContradiction> contradictions;  ///< figures on which recordings contradict each other
    std::vector<MacroMissing> missing;               ///< those with the largest share first
    /// Fraction of the force, integrated over windows, that the model misses: missed_share() in
    /// macro_recordings.h.
    std::optional<double> missed_share;
    double white_noise_mm;  ///< white noise of the readings, from the residuals' differences between ticks
    std::vector<MacroMotion> rivals;  ///< other minima that are compatible with the data
    int reversals = 0;                ///< reversals of the motion in the data, on which friction depends
    double coasted_s = 0.0;           ///< time of motion without drive in the data

    MacroMotion motion;     ///< the fitted model
    double residual_count;  ///< r.m.s. of prediction minus reading over the windows
    double window_s;        ///< length of the windows that were predicted
    int windows;            ///< number of those windows
    double used_s;          ///< recorded time that was used in the fit
    double left_out_s;      ///< recorded time at an end stop, or in pieces too short
};

/// Fits the model of macro_motion.h to all recordings together, closed or open loop.
///
/// Windows last 1 s; where the residuals in them exceed a count, they are halved, down to 0.125 s, because
/// the error from an unmodelled force grows with the square of time while rounding does not. A Coulomb
/// friction or offset that the data cannot separate from the rest is taken as zero and refused. Standard
/// errors include errors correlated over time (calib/batch_variance.h), differences between recordings
/// (calib/heterogeneity.h), and forces that the model lacks (macro_lack.h), by as much as the figure would
/// change if the model had them. A figure is refused where its uncertainty exceeds a fifth, where recordings
/// contradict each other (1 % over all figures) so that no common value is known to a fifth, or where another
/// minimum is about as likely. Fails with Reason::not_identifiable if there are no usable data at all: too
/// short, no command, no motion; with Reason::no_convergence if no finite model fits them.
/// @param traces  may be empty; commands and positions finite, as macro_traces gives them
Result<MacroIdentification> identify_macro(std::span<const MacroTrace> traces, const MacroBuild& build);

}  // namespace fidservo::calib
