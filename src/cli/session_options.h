// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The common options of the commands that drive a rig.
#include "core/plate.h"
#include "core/result.h"
#include "src/session/session.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <CLI/App.hpp>

namespace fidservo {

/// --rig, --stage, --camera, --seed.
void add_session_options(CLI::App& command, SessionOptions& options);

/// --sim-rig.
void add_sim_rig_option(CLI::App& command, SessionOptions& options);

/// --unit, --label: what recordings state about themselves.
void add_origin_options(CLI::App& command, RecordingOrigin& origin);

/// --out, for a command whose run may be recorded.
void add_recording_option(CLI::App& command, std::filesystem::path& out);

/// Runs a command's work, and records all of it where `out` names a folder. A run that fails leaves the
/// recording unfinished. Throws InputError if the folder exists, RunFault.
/// @return the result of the work
int recorded(Session& session, const std::filesystem::path& out, const std::string& experiment,
             const std::function<int()>& work);

/// Ends a run that could not do what was asked: prints "fidservo: WHAT: REASON: text" and returns 1 where the
/// answer is "no" (no tag, out of reach, ...); throws RunFault for faults of devices and for a run that was
/// stopped.
int end_of_run(std::string_view what, const Failure& why);

}  // namespace fidservo
