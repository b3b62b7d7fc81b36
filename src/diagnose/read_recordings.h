// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a diagnosis begins with, whoever asks for it.
#include "core/recording.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// With what their frames show, and what of that is missing.
struct ReadRecordings {
    std::vector<Recording> recordings;
    std::vector<std::string> notes;
};

/// Recordings with their frames measured.
/// @param folders  of each, where its frames are
/// @param interrupted  whether the user wants an end at once; throws gap::BudgetEnded then
ReadRecordings with_frames(std::vector<Recording> recordings,
                           const std::vector<std::filesystem::path>& folders,
                           const std::function<bool()>& interrupted = {});

/// The recordings that paths stand for (find_recordings), with their frames measured. Throws InputError.
/// @param interrupted  as above
ReadRecordings read_recordings(const std::vector<std::filesystem::path>& paths,
                               const std::function<bool()>& interrupted = {});

/// Has the process keep the memory that it was given: predictions take and give back the same few megabytes
/// thousands of times.
void keep_memory();

}  // namespace fidservo::diagnose
