// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Measures the appearance of tags (blur, brightness, noise) in the frames of recordings.
#include "core/recording.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::diagnose {

/// Selects at most `most` frames of a recording for measuring, in the order of time, among those in which it
/// has detections: half of them spread evenly, half where tags move fastest in the image.
std::vector<FrameName> chosen_frames(const Recording& recording, std::size_t most);

/// Adds the appearances of a recording's detections in one of its frames (vision/tags/tag_appearance.h).
void add_appearances(Recording& recording, TimeNs time_ns, const cv::Mat& image);

/// Measures the detections of recordings in their frames, 1200 frames in all at most, shared evenly between
/// the recordings that have some. Each thread holds one frame in memory. Frames that are missing or no images
/// are listed in the result, one line each.
/// @param folders  of the recordings
/// @param interrupted  whether the user wants an end at once; throws gap::BudgetEnded then
std::vector<std::string> measure_frames(std::span<Recording> recordings,
                                        std::span<const std::filesystem::path> folders,
                                        const std::function<bool()>& interrupted = {});

}  // namespace fidservo::diagnose
