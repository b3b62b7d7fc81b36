// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an identification found, as it is printed, written as JSON and into a rig file.
#include "core/preisach.h"
#include "core/rig.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// That holds the truth with 95 %.
struct Interval95 {
    double low, high;
};

/// Value +- what Student's law allows for, where that is wider than a normal law by a tenth; else nothing,
/// since the standard error tells it.
std::optional<Interval95> wide_interval(double value, double std, double freedom);

struct IdentifiedValue {
    std::string key;  ///< in the rig file, e.g. "macro.dead_zone.slope"; else a name of its own
    std::string unit;
    double value = 0.0;
    double std = 0.0;  ///< standard error; NaN where there is none
    bool in_rig_file = true;
    /// Where the standard error alone does not give it: few degrees of freedom, a value at its bound.
    std::optional<Interval95> interval = {};
    double systematic = 0.0;  ///< how far off it may be besides, by what the model lacks
};

/// Two recordings that say different things of one number.
struct Contradiction {
    std::string key;
    double standard_errors;  ///< of the difference, that they are apart
    struct Side {
        std::string recording;
        double value, std;
    };
    Side low, high;
};

/// A force or signal that the recordings show and the model does not have.
struct Missing {
    std::string depends_on;
    double share;  ///< of the residual's squares
};

/// How far the identified model is from the data that it was fitted to.
struct FitResidual {
    std::string signal;
    std::string unit;
    double rms = 0.0;
    std::optional<double> floor;  ///< r.m.s. of noise and rounding alone, where that is known
};

/// What these data do not determine.
struct Undetermined {
    std::string key;
    std::string reason;
};

struct Identified {
    std::string part = {};                     ///< macro, hysteresis, heater, hall
    std::vector<std::string> recordings = {};  ///< or tables, that it comes from
    std::vector<IdentifiedValue> values = {};
    std::vector<FitResidual> residuals = {};
    std::vector<Undetermined> undetermined = {};
    std::vector<StatedEffect> effects =
        {};  ///< what the rig has besides, by the names of the effects' catalogue
    std::shared_ptr<const FodTable> fod = {};
    std::vector<Contradiction> contradictions = {};
    std::vector<Missing> missing = {};        ///< the largest share first
    std::optional<double> missed_share = {};  ///< of the force, r.m.s.
    std::vector<std::string> notes = {};  ///< sentences for people: what was left out, what else was measured
};

/// Whether there is anything that a rig file can hold.
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
