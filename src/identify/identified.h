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

struct IdentifiedValue {
    std::string key;  ///< in the rig file, e.g. "macro.dead_zone.slope"; else a name of its own
    std::string unit;
    double value = 0.0;
    double std = 0.0;  ///< standard error; NaN where there is none
    bool in_rig_file = true;
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
    std::vector<std::string> notes = {};  ///< sentences for people: what was left out, what else was measured
};

/// Whether there is anything that a rig file can hold.
bool fits_a_rig_file(const Identified& identified);

/// The table for people.
std::string describe(const Identified& identified);

/// {"format": "fidservo-identification/1", "part", "recordings", "values", "residuals", "undetermined",
/// "effects", "notes"}. Throws InputError if the file exists, RunFault if the disk fails.
void write_identification_json(const std::filesystem::path& file, const Identified& identified);

/// A copy of a rig file with the identified values in it, and what they come from under `identified`. A table
/// of first-order descending curves is written beside it, as NAME_fod.csv. Throws InputError if a file
/// exists, RunFault if the disk fails.
void write_identified_rig(const std::filesystem::path& file, const std::filesystem::path& source_rig_file,
                          const Identified& identified);

}  // namespace fidservo
