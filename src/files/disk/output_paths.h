// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Output paths of commands: nothing is ever overwritten, and no measurement is lost.
#include <filesystem>

namespace fidservo {

/// Throws InputError if a file that an option names exists, or if nothing can be written where it should be:
/// what it is for may take a rig minutes. @param file  empty where the option was not given
void demand_new_file(const char* option, const std::filesystem::path& file);

/// Makes a new output folder. Throws InputError if something of that name exists or it cannot be made.
void make_output_folder(const std::filesystem::path& folder);

/// Demands that a folder can be made for what is about to be measured, before anything moves: by making it
/// and taking it away again. Throws as make_output_folder() does.
void demand_new_folder(const std::filesystem::path& folder);

/// Renames what an interrupted run left under this name ("NAME.interrupted-1"). Does nothing if there is
/// nothing. Throws RunFault if it cannot be renamed.
void set_aside(const std::filesystem::path& path);

/// Demands that lines can be appended to a file, which need not exist, before any work is done for them.
/// Throws InputError.
/// @param option  by which the file was given
void demand_appendable(const char* option, const std::filesystem::path& file);

}  // namespace fidservo
