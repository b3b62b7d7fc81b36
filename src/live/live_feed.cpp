// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/live/live_feed.h"

#include <utility>

namespace fidservo {

void LiveFeed::tick(const StageRow& row) {
    if (++ticks_ < ticks_per_point) return;
    ticks_ = 0;
    points_.push(StageRow(row));
}

void LiveFeed::found(const std::vector<TagDetection>& tags) {
    if (frame_ && picture_.is_empty())
        picture_.put(std::make_unique<LivePicture>(LivePicture{*std::exchange(frame_, std::nullopt), tags}));
    frame_.reset();
}

void LiveFeed::take_points(std::vector<StageRow>& points) {
    for (StageRow row; points_.pop(row);) points.push_back(row);
}

}  // namespace fidservo
