// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From recordings to all that is said of them: the same for every command that diagnoses, and for Python.
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

/// What to try and what matters, as users say it.
struct Asked {
    std::vector<std::string> only, without;  ///< effects, by their names
    std::filesystem::path effects_file;      ///< empty: none
    std::vector<std::string> matters;        ///< src/diagnose/matters.h
};

/// The same as the diagnosis takes it. Throws InputError that names --effects, --without, --effects-file or
/// --matters.
gap::DiagnosisOptions options_of(const Asked& asked, const Rig& rig);

/// How a diagnosis goes.
struct Conduct {
    /// What it may search, in seconds of effort (gap::Seconds::by_effort), for recordings of ten minutes or
    /// less: on one core the same on any machine. Empty: half a minute by the clock.
    std::optional<double> effort_s = {};
    /// Half a minute by the clock however long the recordings are; neither an equation nor a next experiment.
    bool is_brief = false;
    std::function<bool()> interrupted = {};  ///< whether the user wants an end at once
    /// What is tried, and how much of the time or the effort is gone, 0 to 1. Any thread may call it.
    std::function<void(std::string_view what, double share)> tell = {};
    /// Since when the clock runs: reading counts.
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
};

/// Seconds of effort that stand for half a minute.
double usual_effort_s();

/// What is said, and what of.
struct Answer {
    gap::Evidence evidence;  ///< its budget is still running
    gap::Diagnosis diagnosis;
    TimeLimit limit;  ///< that there was
};

/// Long recordings are thinned (src/diagnose/thinned.h); the notes of reading and thinning follow those of
/// the diagnosis. Throws InputError and gap::BudgetEnded as gap::diagnose() does.
/// @param options  but for their time and their progress, which are set here
Answer diagnose_recordings(const Rig& rig, ReadRecordings read, gap::DiagnosisOptions options,
                           const Conduct& conduct = {});

}  // namespace fidservo::diagnose
