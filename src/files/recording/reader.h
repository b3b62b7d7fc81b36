// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recording folders in the ASL/EuRoC layout (docs/formats.md).
#include "core/recording.h"

#include <filesystem>
#include <vector>

namespace fidservo {

/// Reads a recording: recording.yaml, and whichever there are of plate.yaml, stage0/data.csv, cam0/data.csv
/// and cam0/detections.csv. Columns are known by name and unit and may stand in any order. Throws InputError
/// "FILE:LINE: ..." on anything that is not as it should be: a file cut off in mid-line, numbers that are not
/// finite, time that does not increase, columns that are missing, unknown or in another unit.
/// Where recording.yaml says that it is unfinished, a last line that does not end is left out, and a file
/// without a whole line counts as not there.
Recording read_recording(const std::filesystem::path& folder);

/// Detections of a recording that has a plate are of tags printed as the plate's.
void give_print_of_plate(Recording& recording);

/// Expands a path to recordings: itself if it holds recording.yaml, else the folders in it that do, by name;
/// else those in its folder "recordings", where an inspection keeps them. Throws InputError if there are
/// none.
std::vector<std::filesystem::path> find_recordings(const std::filesystem::path& path);

/// The list of a camera folder's frames, by time: of a recording its cam0/data.csv; of a folder that another
/// program wrote, without recording.yaml in the folder above, whatever read_frame_index() reads. Throws
/// InputError.
std::vector<FrameName> read_frame_names(const std::filesystem::path& file);

/// cam0/detections.csv: a row per tag and frame, by time. Throws InputError.
std::vector<TagDetection> read_detections(const std::filesystem::path& file);

}  // namespace fidservo
