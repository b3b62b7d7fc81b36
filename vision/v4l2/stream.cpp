// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/stream.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "vision/v4l2/capability.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>

namespace fidservo::vision::v4l2 {

namespace {

template <class T>
T take_or_throw(Result<T> result) {
    if (!result) throw RunFault(result.error().text);
    return *std::move(result);
}

void demand_capture(const Device& device, const Capability& capability) {
    if (!capability.captures || !capability.streams)
        throw InputError(fmt::format("{}: \"{}\" is no camera that streams single-planar video",
                                     device.node().string(), capability.card));
}

void ask_for_source_changes(const Device& device) {
    v4l2_event_subscription wanted{};
    wanted.type = V4L2_EVENT_SOURCE_CHANGE;
    int input = 0;
    if (device.request(VIDIOC_G_INPUT, &input) == 0) wanted.id = static_cast<std::uint32_t>(input);
    (void)device.request(VIDIOC_SUBSCRIBE_EVENT, &wanted);  // sources that cannot change have no such event
}

}  // namespace

FrameStream::FrameStream(const std::filesystem::path& node, const CaptureSettings& settings) {
    Device device = take_or_throw(Device::open(node));
    const Capability capability = take_or_throw(capability_of(device));
    demand_capture(device, capability);
    card_ = capability.card;
    leased_frames_stay_ = capability.driver != "v4l2 loopback";
    format_ = set_format(device, settings);
    lock_ = lock_controls(device, settings);
    frame_rate_hz_ = v4l2::frame_rate_hz(device);
    ask_for_source_changes(device);
    queue_ = BufferQueue::start(std::move(device), settings.memory, format_.frame_bytes);
}

FrameStream::~FrameStream() {
    queue_->stop();
}

Result<Wake> FrameStream::wait(int wake_fd, TimeNs at_most_ns) {
    std::array<pollfd, 2> watched{pollfd{queue_->device().fd(), POLLIN | POLLPRI, 0},
                                  pollfd{wake_fd, POLLIN, 0}};
    const TimeNs at_most_ms = std::max<TimeNs>(0, (at_most_ns + ns_per_ms - 1) / ns_per_ms);
    const int ready = ::poll(watched.data(), watched.size(), static_cast<int>(at_most_ms));
    if (ready < 0 && errno != EINTR)
        return failure(Reason::device, queue_->device().refusal("it cannot be waited for", errno));
    if (ready <= 0) return ready == 0 ? Wake::late : Wake::ready;
    if (watched[1].revents != 0) return Wake::told;
    const short events = watched[0].revents;
    if ((events & POLLPRI) != 0 && source_changed())
        return failure(Reason::device,
                       fmt::format("{}: the source changed under way", queue_->device().node().string()));
    return (events & (POLLERR | POLLHUP | POLLNVAL)) != 0 ? Wake::broken : Wake::ready;
}

bool FrameStream::source_changed() {
    bool changed = false;
    v4l2_event event{};
    while (queue_->device().request(VIDIOC_DQEVENT, &event) == 0)
        changed = changed || event.type == V4L2_EVENT_SOURCE_CHANGE;
    return changed;
}

Status FrameStream::check_format() const {
    const std::string now = format_in_force(queue_->device());
    if (now == text_of(format_)) return {};
    return failure(Reason::device, fmt::format("{}: the format changed under way, from {} to {}",
                                               queue_->device().node().string(), text_of(format_), now));
}

}  // namespace fidservo::vision::v4l2
