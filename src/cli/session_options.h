// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the commands that drive a rig have in common.
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

/// --unit, --label: what recordings say of themselves.
void add_origin_options(CLI::App& command, RecordingOrigin& origin);

/// --out, for a command whose work may be recorded.
void add_recording_option(CLI::App& command, std::filesystem::path& out);

/// Does a command's work, and records all of it where `out` names a folder. A run that cannot go on leaves
/// the recording as it is, unfinished. Throws InputError if the folder exists, RunFault.
/// @return what the work returns
int recorded(Session& session, const std::filesystem::path& out, const std::string& experiment,
             const std::function<int()>& work);

/// How a run that could not do what was asked ends: prints "fidservo: WHAT: REASON: text" and returns 1 where
/// the answer is "no" (no tag, out of reach, ...); throws RunFault for faults of devices and for a run that
/// was stopped.
int end_of_run(std::string_view what, const Failure& why);

}  // namespace fidservo
