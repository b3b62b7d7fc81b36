// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// detections.csv and displacements.csv as `replay` writes them.
#include "core/detection.h"
#include "src/files/disk/durable_file.h"
#include "src/images/image_frame.h"
#include "vision/displacement.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// A row of detections.csv without its first column: the tag's id, its corners and their covariances.
std::string detection_row(const TagDetection& tag);

/// The two tables, frame by frame. The first column is the frame's time, or its name. Throws RunFault if the
/// disk fails.
class ReplayTables {
  public:
    /// Makes the two files in a folder that is there.
    ReplayTables(const std::filesystem::path& folder, bool with_times);

    /// @param detections  rows, of detection_row()
    void add(const ImageFrame& frame, std::span<const std::string> detections,
             std::span<const vision::Displacement> displacements);
    /// Waits until the disk has it all.
    void close();

  private:
    bool with_times_;
    DurableFile detections_;
    DurableFile displacements_;
};

}  // namespace fidservo
