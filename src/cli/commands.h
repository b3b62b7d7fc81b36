// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pattern of a command: a file of its own with an options struct, `int run_NAME(const NameOptions&)` that
// returns an exit code, and `add_NAME`, which adds the subcommand to the program and, when it was chosen,
// runs it and stores its exit code. src/cli/cli.cpp lists them.
//
// A command throws InputError (exit 2) and RunFault (exit 3); it prints results on stdout.
#include "src/files/disk/output_paths.h"
#include "src/process/exit_code.h"

#include <filesystem>
#include <string>

#include <CLI/App.hpp>

namespace fidservo {

void add_goto(CLI::App& app, int& exit_code);
void add_home(CLI::App& app, int& exit_code);
void add_inspect(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_cameras(CLI::App& app, int& exit_code);
void add_identify(CLI::App& app, int& exit_code);
void add_reproduce(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_calibrate_camera(CLI::App& calibrate, int& exit_code);
void add_calibrate_stage(CLI::App& calibrate, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_diagnose(CLI::App& app, int& exit_code);
void add_rig(CLI::App& app, int& exit_code);
void add_import(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_fleet(CLI::App& app, int& exit_code);
void add_fleet_report(CLI::App& fleet, int& exit_code);

/// --rig RIG.yaml; the reference rig where it is not given.
void add_rig_option(CLI::App& command, std::filesystem::path& rig_file);

/// Adds an example at the end of a command's --help.
void add_example(CLI::App& command, const std::string& example);

}  // namespace fidservo
