// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Identification of the macro stage from recordings: gain, time constant, dead zone, friction, offset, each
// with its standard error, or the reason why these data do not determine it.
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

/// What is known of the rig beforehand: its build, not its dynamics.
struct MacroBuild {
    double resolution_mm;    ///< of the encoder
    Travel travel;           ///< in the encoder's frame; infinite where the encoder's origin is unknown
    double command_limit_V;  ///< larger recorded commands are taken as this
    bool dead_zone;          ///< whether friction shows as a dead zone on the command
    double unit_V;           ///< the command at which the effective voltage is 1 V, which defines the gain
    double threshold_V;      ///< the rig file's; used for a0 where the data leave the threshold open
};

/// From a rig file. The unit is where its dead zone lets 1 V pass: 4 V on the reference rig, (1 - a0) / delta
/// above the threshold.
MacroBuild macro_build(const MacroParameters& macro);

/// A number with its standard error.
struct MacroEstimate {
    double value;                                              ///< in the unit of its name
    double std;                                                ///< one standard error
    double freedom = std::numeric_limits<double>::infinity();  ///< of Student's law for intervals

    /// How far off it may be besides, if what the model lacks goes with the figure as much as it does not:
    /// the residual beyond noise as one coherent error (Cauchy and Schwarz). 0 where there is no such
    /// residual.
    double systematic = 0.0;

    /// Half the width of the interval that holds the truth with 95 %.
    double reach_95() const;
};

/// Two recordings that contradict each other.
struct MacroContradiction {
    std::string figure;  ///< "gain", "time constant", ...
    double apart;        ///< in standard errors of the difference
    /// The recordings that have the lowest and the highest value.
    std::string low_recording, high_recording;
    /// What these recordings say.
    MacroEstimate low, high;
};

/// A force that the recordings show and the model does not have.
struct MacroMissing {
    std::string depends_on;  ///< what the force depends on: position, speed, ...
    double share;            ///< of the residual's squares
};

/// Each of these is determined or refused by itself (Reason::not_identifiable).
struct MacroIdentification {
    Result<MacroEstimate> gain_mm_per_s_per_V;  ///< K: speed per effective volt, 1 V at unit_V
    Result<MacroEstimate> time_constant_s;      ///< tau
    Result<MacroEstimate> threshold_V;          ///< the smallest command that moves the carriage
    Result<MacroEstimate> zone_offset_V;        ///< a0: effective voltage at the threshold, eq. (7)
    Result<MacroEstimate> zone_slope;           ///< delta, eq. (7)
    Result<MacroEstimate> friction_V;           ///< Coulomb friction in effective volts
    Result<MacroEstimate> drive_offset_V;       ///< a command that stands for a force on the carriage
    bool threshold_assumed = false;             ///< a0 is for the rig file's threshold
    bool friction_at_bound = false;             ///< friction came out at 0, below which it cannot be

    /// Where gain and time constant cannot be told apart: their ratio, the acceleration that a volt gives.
    std::optional<MacroEstimate> acceleration_mm_per_s2_per_V;
    std::vector<MacroContradiction> contradictions;  ///< where recordings contradict each other
    std::vector<MacroMissing> missing;               ///< the largest share first
    /// Of the force, integrated over windows: see missed_share() in macro_recordings.h.
    std::optional<double> missed_share;
    double white_noise_mm;            ///< of the readings, as residuals show it from tick to tick
    std::vector<MacroMotion> rivals;  ///< other minima that the data do not exclude
    int reversals = 0;                ///< turns of direction that it was told by
    double coasted_s = 0.0;           ///< time without drive that it was told by

    MacroMotion motion;     ///< the fitted model
    double residual_count;  ///< r.m.s. of prediction minus reading over the windows
    double window_s;        ///< length of the windows that were predicted
    int windows;            ///< how many they are
    double used_s;          ///< recorded time that entered the fit
    double left_out_s;      ///< at an end stop, or in pieces too short
};

/// Fits the model of macro_motion.h to all recordings together, closed or open loop.
///
/// Windows last 1 s; where the model leaves more than a count unexplained in them, they are halved, down to
/// 0.125 s, because an unmodelled force moves a prediction by the square of time while rounding does not
/// grow. A Coulomb friction or offset that the data cannot tell from the rest is taken as zero and refused.
/// Standard errors count what makes estimates scatter: errors correlated over time (calib/batch_variance.h),
/// recordings that differ (calib/heterogeneity.h), and a force that the model lacks (macro_lack.h), by as
/// much as the figure would move if the model had it. A figure is refused where the data leave it wider than
/// a fifth, where recordings contradict each other (1 % over all figures) so that no common value is known to
/// a fifth, or where another minimum is about as likely. Fails with Reason::not_identifiable if there are no
/// usable data at all: too short, no command, no motion; with Reason::no_convergence if no finite model
/// follows them.
/// @param traces  may be empty; commands and positions finite, as macro_traces gives them
Result<MacroIdentification> identify_macro(std::span<const MacroTrace> traces, const MacroBuild& build);

}  // namespace fidservo::calib
