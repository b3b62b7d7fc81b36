// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is found in a stretch of images, as its result holds it.
#include "src/images/image_frame.h"
#include "src/replay/tag_finder.h"
#include "vision/displacement.h"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace fidservo::fleet {

/// Of a frame: an object with "time_ns" where it has a time, and either "damage", or "detections" (rows of
/// detections.csv without the first column) and "places", [tag, u, v, variances, side, its std] each. Numbers
/// read back as they were.
nlohmann::ordered_json frame_json(const FrameResult& result, const std::string& damage);

/// The same taken back.
struct FrameFound {
    ImageFrame frame;  ///< without name and image
    std::vector<std::string> detections;
    std::vector<vision::TagPlace> places;
};
/// Throws nlohmann::json::exception where it is none.
FrameFound frame_found(const nlohmann::json& json);

}  // namespace fidservo::fleet
