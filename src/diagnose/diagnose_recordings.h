// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From recordings to a complete diagnosis: the same for every command that diagnoses, and for Python.
#include "gap/diagnose.h"
#include "src/diagnose/read_recordings.h"
#include "src/diagnose/time_limit.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::diagnose {

/// What to try and which gaps matter, in the words of the options.
struct Asked {
    std::vector<std::string> only, without;  ///< names of effects
    std::filesystem::path effects_file;      ///< empty: no file
    std::vector<std::string> matters;        ///< the arguments of --matters (src/diagnose/matters.h)
};

/// The same as options of the diagnosis. Throws InputError that names --effects, --without, --effects-file or
/// --matters.
gap::DiagnosisOptions options_of(const Asked& asked, const Rig& rig);

/// How a diagnosis is run.
struct Conduct {
    /// The search's limit in seconds of effort (gap::Seconds::by_effort), for recordings of ten minutes or
    /// less; the result is the same on any machine if one core is used. Empty: half a minute by the clock.
    std::optional<double> effort_s = {};
    /// Limits the diagnosis to half a minute by the clock however long the recordings are, without an
    /// equation or a next experiment.
    bool is_brief = false;
    std::function<bool()> interrupted = {};  ///< whether the user wants an end at once
    /// Receives what is being tried, and the fraction of the time or effort spent, 0 to 1. It may be called
    /// by any thread.
    std::function<void(std::string_view what, double share)> tell = {};
    /// Start of the clock; reading the recordings counts.
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
};

/// Seconds of effort that correspond to half a minute.
double usual_effort_s();

/// A diagnosis with its data.
struct Answer {
    gap::Evidence evidence;  ///< its budget is still running
    gap::Diagnosis diagnosis;
    TimeLimit limit;  ///< the time limit that applied
};

/// Long recordings are thinned (src/diagnose/thinned.h); the notes of reading and thinning follow those of
/// the diagnosis. Throws InputError and gap::BudgetEnded as gap::diagnose() does.
/// @param options  its times and its progress function are set here
Answer diagnose_recordings(const Rig& rig, ReadRecordings read, gap::DiagnosisOptions options,
                           const Conduct& conduct = {});

}  // namespace fidservo::diagnose
