// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A live feed with the data of a run.
#include "src/live/live_feed.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace fidservo::testing {

/// A frame with a dark square where the tag is reported.
inline vision::Frame frame_with_square(TimeNs time_ns) {
    vision::Frame frame;
    frame.image = cv::Mat(960, 1280, CV_8UC1, cv::Scalar(200));
    frame.image(cv::Rect(490, 330, 300, 300)).setTo(20);
    frame.time_ns = time_ns;
    return frame;
}

inline std::vector<TagDetection> tag_on_square(int id) {
    TagDetection tag;
    tag.tag_id = id;
    tag.corners_px = {{{489.5, 629.5}, {789.5, 629.5}, {789.5, 329.5}, {489.5, 329.5}}};
    return {tag};
}

/// Fills in ten seconds of a moving stage, a picture, and three sites.
inline void show_run(LiveFeed& feed) {
    for (int k = 0; k < 10000; ++k) {
        StageRow row;
        row.time_ns = k * ns_per_ms;
        row.encoder_count = 2000 + std::min(400.0, 0.2 * k);
        row.macro_command_V = k < 2000 ? 4.0 : 0.0;
        row.micro_command_V = 1.5 + 0.1 * std::sin(0.002 * k);
        row.hall_adc = 2048 + 500 * std::sin(0.002 * k);
        feed.tick(row);
    }
    feed.saw(frame_with_square(9 * ns_per_s));
    feed.found(tag_on_square(12));
    feed.is_at(
        {"Demo plate", "site 12", "", {{11, 22.0, "pass"}, {12, 24.0, "under_way"}, {13, 26.0, "waiting"}}});
}

}  // namespace fidservo::testing
