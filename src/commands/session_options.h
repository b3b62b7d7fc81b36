#pragma once
// What the commands that drive a rig have in common.
#include "core/plate.h"
#include "core/result.h"
#include "src/session/session.h"

#include <string_view>

#include <CLI/App.hpp>

namespace fidservo {

/// --rig, --stage, --camera, --seed.
void add_session_options(CLI::App& command, SessionOptions& options);

/// --sim-rig.
void add_sim_rig_option(CLI::App& command, SessionOptions& options);

/// The plate that the rig file describes. Throws InputError if it describes none.
Plate rig_plate(const Rig& rig, const std::filesystem::path& rig_file);

/// How a run that could not do what was asked ends: prints "fidservo: WHAT: REASON: text" and returns 1 where
/// the answer is "no" (no tag, out of reach, ...); throws RunFault for faults of devices and for a run that
/// was stopped.
int end_of_run(std::string_view what, const Failure& why);

}  // namespace fidservo
