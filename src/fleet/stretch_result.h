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

/// The JSON object of a frame: "time_ns" if it has a time, and either "damage", or "detections" (rows of
/// detections.csv without the first column) and "places", each [tag, u, v, variances, side, the side's std].
/// Numbers are written such that they are read back without loss.
nlohmann::ordered_json frame_json(const FrameResult& result, const std::string& damage);

/// What frame_json() has stored.
struct FrameFound {
    ImageFrame frame;  ///< without name and image
    std::vector<std::string> detections;
    std::vector<vision::TagPlace> places;
};
/// The inverse of frame_json(). Throws nlohmann::json::exception if the object is not of this form.
FrameFound frame_found(const nlohmann::json& json);

}  // namespace fidservo::fleet
