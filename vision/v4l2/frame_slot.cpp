// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/frame_slot.h"

#include <utility>

namespace fidservo::vision::v4l2 {

void FrameSlot::put(RawFrame frame) {
    std::optional<RawFrame> older(std::move(frame));
    const std::lock_guard lock(mutex_);
    std::swap(newest_, older);
    if (older) ++counts_.skipped;
}

Result<std::optional<RawFrame>> FrameSlot::take(TimeNs now_ns) {
    const std::lock_guard lock(mutex_);
    if (failure_) return tl::make_unexpected(*failure_);
    if (newest_ && newest_->arrival_ns > now_ns) return std::optional<RawFrame>();
    return std::exchange(newest_, std::nullopt);
}

void FrameSlot::fail(Failure why) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(why);
    newest_.reset();
}

void FrameSlot::clear() {
    const std::lock_guard lock(mutex_);
    newest_.reset();
}

void FrameSlot::count(const FrameCounts& more) {
    const std::lock_guard lock(mutex_);
    counts_ += more;
}

FrameCounts FrameSlot::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

}  // namespace fidservo::vision::v4l2
