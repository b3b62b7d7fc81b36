// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The result of an identification, for the terminal, JSON and rig files.
#include "core/preisach.h"
#include "core/rig.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// A 95 % confidence interval.
struct Interval95 {
    double low, high;
};

/// The interval by Student's distribution where that is wider by a tenth than by a normal one; empty where
/// the standard error suffices.
std::optional<Interval95> wide_interval(double value, double std, double freedom);

struct IdentifiedValue {
    std::string key;  ///< key in the rig file, e.g. "macro.dead_zone.slope"; else a name of its own
    std::string unit;
    double value = 0.0;
    double std = 0.0;  ///< standard error; NaN where there is none
    bool in_rig_file = true;
    /// Set where the standard error does not suffice: few degrees of freedom, or a value at its bound.
    std::optional<Interval95> interval = {};
    double systematic = 0.0;  ///< bound of an additional error from forces that the model lacks
};

/// Two recordings with contradicting estimates of a number.
struct Contradiction {
    std::string key;
    double standard_errors;  ///< their difference in its standard errors
    struct Side {
        std::string recording;
        double value, std;
    };
    Side low, high;
};

/// A force or signal that the recordings show and the model does not have.
struct Missing {
    std::string depends_on;
    double share;  ///< fraction of the residual's sum of squares
};

/// The residual between the identified model and its data.
struct FitResidual {
    std::string signal;
    std::string unit;
    double rms = 0.0;
    std::optional<double> floor;  ///< r.m.s. expected from noise and rounding alone, where known
};

/// A number that the data do not determine.
struct Undetermined {
    std::string key;
    std::string reason;
};

struct Identified {
    std::string part = {};                     ///< macro, hysteresis, heater, hall
    std::vector<std::string> recordings = {};  ///< recordings or tables from which it comes
    std::vector<IdentifiedValue> values = {};
    std::vector<FitResidual> residuals = {};
    std::vector<Undetermined> undetermined = {};
    std::vector<StatedEffect> effects = {};  ///< further effects of the rig, by the names of the catalogue
    std::shared_ptr<const FodTable> fod = {};
    std::vector<Contradiction> contradictions = {};
    std::vector<Missing> missing = {};        ///< the largest share first
    std::optional<double> missed_share = {};  ///< fraction of the force that the model misses, r.m.s.
    std::vector<std::string> notes = {};      ///< sentences: what was left out, what else was measured
};

/// Whether it has anything that a rig file can state.
bool fits_a_rig_file(const Identified& identified);

/// "a says 61.86 +- 0.66, b says 80.7 +- 1.1", the sides of a contradiction.
std::string sides_of(const Contradiction& contradiction);

/// The table for people.
std::string describe(const Identified& identified);

/// {"format": "fidservo-identification/1", "part", "recordings", "values", "residuals", "undetermined",
/// "contradictions", "missing", "missed_share", "effects", "notes"}. Throws InputError if the file exists,
/// RunFault if the disk fails.
void write_identification_json(const std::filesystem::path& file, const Identified& identified);

/// A copy of a rig file with the identified values in it, and what they come from under `identified`. A table
/// of first-order descending curves is written beside it, as NAME_fod.csv. Throws InputError if a file
/// exists, RunFault if the disk fails.
void write_identified_rig(const std::filesystem::path& file, const std::filesystem::path& source_rig_file,
                          const Identified& identified);

}  // namespace fidservo
