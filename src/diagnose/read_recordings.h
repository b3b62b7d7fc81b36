// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Reading the recordings for a diagnosis.
#include "core/recording.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// Recordings with the appearances measured in their frames, and notes on what is missing.
struct ReadRecordings {
    std::vector<Recording> recordings;
    std::vector<std::string> notes;
};

/// Recordings with their frames measured.
/// @param folders  of the recordings, where their frames are
/// @param interrupted  whether the user wants an end at once; throws gap::BudgetEnded then
ReadRecordings with_frames(std::vector<Recording> recordings,
                           const std::vector<std::filesystem::path>& folders,
                           const std::function<bool()>& interrupted = {});

/// The recordings that paths stand for (find_recordings), with their frames measured. Throws InputError.
/// @param interrupted  as above
ReadRecordings read_recordings(const std::vector<std::filesystem::path>& paths,
                               const std::function<bool()>& interrupted = {});

/// Makes the process keep memory that it has freed: predictions allocate and free the same few megabytes
/// thousands of times.
void keep_memory();

}  // namespace fidservo::diagnose
