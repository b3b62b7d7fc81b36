// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/devices/fake_state.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <unistd.h>

namespace fidservo::devices {

namespace {

void use(const FakeFormat& format, v4l2_pix_format& into) {
    into.width = static_cast<std::uint32_t>(format.width_px);
    into.height = static_cast<std::uint32_t>(format.height_px);
    into.pixelformat = format.fourcc;
    into.field = V4L2_FIELD_NONE;
    into.bytesperline = format.bytes_per_line;
    into.sizeimage =
        format.bytes_per_line == 0 ? into.width * into.height * 2 : format.bytes_per_line * into.height;
}

template <std::size_t n>
void write_text(const std::string& text, __u8 (&field)[n]) {
    std::strncpy(reinterpret_cast<char*>(field), text.c_str(), n - 1);
}

}  // namespace

FakeCamera::State::State(FakeProperties given) : properties(std::move(given)) {
    use(properties.formats.front(), current);
}

int FakeCamera::State::answer(unsigned long request, std::vector<std::byte>& argument,
                              const Pointed& pointed) {
    void* a = argument.data();
    {
        const std::lock_guard lock(mutex);
        if (unplugged) return ENODEV;
    }
    if (request == VIDIOC_DQBUF) {
        // With a real camera the program waits in poll(); here poll() returns at once, so the wait is here.
        for (int k = 0; k < 4 && waiting_is_empty(); ++k)
            std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    const std::lock_guard lock(mutex);
    switch (request) {
        case VIDIOC_QUERYCAP:
            return capability(*static_cast<v4l2_capability*>(a));
        case VIDIOC_ENUM_FMT:
            return list_format(*static_cast<v4l2_fmtdesc*>(a));
        case VIDIOC_ENUM_FRAMESIZES:
            return list_size(*static_cast<v4l2_frmsizeenum*>(a));
        case VIDIOC_ENUM_FRAMEINTERVALS:
            return list_rate(*static_cast<v4l2_frmivalenum*>(a));
        case VIDIOC_G_FMT:
            static_cast<v4l2_format*>(a)->fmt.pix = current;
            return 0;
        case VIDIOC_S_FMT:
            return set_format(*static_cast<v4l2_format*>(a));
        case VIDIOC_G_PARM:
        case VIDIOC_S_PARM:
            return rate(*static_cast<v4l2_streamparm*>(a));
        case VIDIOC_QUERY_EXT_CTRL:
            return describe_control(*static_cast<v4l2_query_ext_ctrl*>(a));
        case VIDIOC_G_EXT_CTRLS:
            return exchange_control(false, pointed);
        case VIDIOC_S_EXT_CTRLS:
            return exchange_control(true, pointed);
        case VIDIOC_REQBUFS:
            return give_buffers(*static_cast<v4l2_requestbuffers*>(a));
        case VIDIOC_QUERYBUF:
            return describe_buffer(*static_cast<v4l2_buffer*>(a));
        case VIDIOC_QBUF:
            return queue(*static_cast<v4l2_buffer*>(a));
        case VIDIOC_DQBUF:
            return dequeue(*static_cast<v4l2_buffer*>(a));
        case VIDIOC_STREAMON:
            streaming = properties.stream_error == 0;
            return properties.stream_error;
        case VIDIOC_STREAMOFF:
            streaming = false;
            queued.clear();
            return 0;
        default:
            return ENOTTY;
    }
}

bool FakeCamera::State::waiting_is_empty() const {
    const std::lock_guard lock(mutex);
    return exposed.empty();
}

int FakeCamera::State::capability(v4l2_capability& answer) const {
    write_text(properties.driver, answer.driver);
    write_text("Fake camera", answer.card);
    write_text("platform:fake", answer.bus_info);
    answer.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    answer.capabilities = answer.device_caps | V4L2_CAP_DEVICE_CAPS;
    return 0;
}

int FakeCamera::State::list_format(v4l2_fmtdesc& answer) const {
    if (answer.index >= properties.formats.size()) return EINVAL;
    answer.pixelformat = properties.formats[answer.index].fourcc;
    write_text("of the fake camera", answer.description);
    return 0;
}

int FakeCamera::State::list_size(v4l2_frmsizeenum& answer) const {
    if (answer.index > 0) return EINVAL;
    for (const FakeFormat& format : properties.formats) {
        if (format.fourcc != answer.pixel_format) continue;
        answer.type = V4L2_FRMSIZE_TYPE_DISCRETE;
        answer.discrete = {static_cast<std::uint32_t>(format.width_px),
                           static_cast<std::uint32_t>(format.height_px)};
        return 0;
    }
    return EINVAL;
}

int FakeCamera::State::list_rate(v4l2_frmivalenum& answer) const {
    if (answer.index > 1) return EINVAL;
    answer.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    answer.discrete = {1, answer.index == 0 ? 50U : 25U};
    return 0;
}

int FakeCamera::State::set_format(v4l2_format& format) {
    FakeFormat nearest = properties.formats.front();
    for (const FakeFormat& offered : properties.formats)
        if (offered.fourcc == format.fmt.pix.pixelformat) nearest = offered;
    use(nearest, current);
    format.fmt.pix = current;
    return 0;
}

int FakeCamera::State::rate(v4l2_streamparm& answer) const {
    answer.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    answer.parm.capture.timeperframe = {1, 50};
    return 0;
}

int FakeCamera::State::describe_control(v4l2_query_ext_ctrl& answer) const {
    const bool next = (answer.id & V4L2_CTRL_FLAG_NEXT_CTRL) != 0;
    const std::uint32_t id = answer.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    const FakeControl* found = nullptr;
    for (const FakeControl& control : properties.controls)
        if ((next ? control.id > id : control.id == id) && (found == nullptr || control.id < found->id))
            found = &control;
    if (found == nullptr) return EINVAL;
    answer = {};
    answer.id = found->id;
    answer.type = found->type;
    std::strncpy(answer.name, found->name.c_str(), sizeof answer.name - 1);
    answer.minimum = found->minimum;
    answer.maximum = found->maximum;
    answer.step = static_cast<std::uint64_t>(found->step);
    return 0;
}

int FakeCamera::State::exchange_control(bool set, const Pointed& pointed) {
    std::vector<std::byte> bytes(sizeof(v4l2_ext_control));
    constexpr std::size_t at = offsetof(v4l2_ext_controls, controls);
    if (!pointed.read(at, bytes)) return EFAULT;
    v4l2_ext_control control{};
    std::memcpy(&control, bytes.data(), sizeof control);
    const auto found = std::ranges::find(properties.controls, control.id, &FakeControl::id);
    if (found == properties.controls.end()) return EINVAL;
    if (set) {
        if (!found->deaf) found->value = control.value;
        return 0;
    }
    control.value = static_cast<std::int32_t>(found->value);
    std::memcpy(bytes.data(), &control, sizeof control);
    return pointed.write(at, bytes) ? 0 : EFAULT;
}

int FakeCamera::State::give_buffers(v4l2_requestbuffers& request) {
    const bool offered = request.memory == V4L2_MEMORY_MMAP ? properties.maps : properties.takes_memory;
    if (!offered) return EINVAL;
    request.count = std::min(request.count, most_buffers);
    memory = request.memory;
    queued.clear();
    return 0;
}

int FakeCamera::State::describe_buffer(v4l2_buffer& buffer) const {
    buffer.length = buffer_stride;
    buffer.m.offset = static_cast<std::uint32_t>(buffer.index * buffer_stride);
    return 0;
}

int FakeCamera::State::queue(v4l2_buffer& buffer) {
    queued.push_back(buffer.index);
    user_memory[buffer.index] = buffer.m.userptr;
    return 0;
}

int FakeCamera::State::dequeue(v4l2_buffer& buffer) {
    if (!streaming) return EINVAL;
    if (exposed.empty()) return EAGAIN;
    const FakeFrame frame = std::move(exposed.front());
    exposed.pop_front();
    const std::uint32_t index = queued.front();
    queued.pop_front();
    buffer.index = index;
    buffer.sequence = frame.sequence;
    buffer.flags = frame.flags;
    buffer.bytesused = static_cast<std::uint32_t>(frame.bytes.size());
    buffer.timestamp = {frame.stamp_us / 1'000'000, frame.stamp_us % 1'000'000};
    if (memory == V4L2_MEMORY_USERPTR) {
        std::memcpy(reinterpret_cast<void*>(user_memory[index]), frame.bytes.data(), frame.bytes.size());
        buffer.m.userptr = user_memory[index];
        return 0;
    }
    const auto written =
        ::pwrite(node_fd, frame.bytes.data(), frame.bytes.size(), static_cast<off_t>(index * buffer_stride));
    return written == static_cast<ssize_t>(frame.bytes.size()) ? 0 : EIO;
}

}  // namespace fidservo::devices
