// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/buffer_queue.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/input_error.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/mman.h>

namespace fidservo::vision::v4l2 {

namespace {

/// Two for the driver, two in use, two in between.
constexpr std::uint32_t wanted_buffers = 6;
constexpr std::size_t page_bytes = 4096;

std::uint32_t code_of(Memory memory) {
    return memory == Memory::mapped ? V4L2_MEMORY_MMAP : V4L2_MEMORY_USERPTR;
}

v4l2_buffer description_of(Memory memory, std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = code_of(memory);
    buffer.index = index;
    return buffer;
}

Stamp stamp_of(const v4l2_buffer& buffer) {
    const bool monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    const bool start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    return {buffer.timestamp.tv_sec * ns_per_s + buffer.timestamp.tv_usec * 1000,
            monotonic ? StampClock::monotonic : StampClock::other,
            start ? StampEvent::start_of_exposure : StampEvent::end_of_frame};
}

}  // namespace

void BufferQueue::Unmap::operator()(std::byte* start) const {
    if (memory == Memory::mapped)
        ::munmap(start, bytes);
    else
        std::free(start);
}

BufferQueue::BufferQueue(Device device, std::size_t frame_bytes)
    : frame_bytes_(frame_bytes), device_(std::move(device)) {}

BufferQueue::~BufferQueue() {
    stop();
}

std::shared_ptr<BufferQueue> BufferQueue::start(Device device, Memory memory, std::size_t frame_bytes) {
    const std::shared_ptr<BufferQueue> queue(new BufferQueue(std::move(device), frame_bytes));
    const Memory other = memory == Memory::mapped ? Memory::user : Memory::mapped;
    int error = queue->request_buffers(memory);
    if (error == EINVAL || error == ENOTTY) error = queue->request_buffers(other);
    if (error != 0)
        throw RunFault(queue->device().refusal("it gives no buffers to stream into (VIDIOC_REQBUFS)", error));
    queue->start_stream();
    return queue;
}

int BufferQueue::request_buffers(Memory memory) {
    v4l2_requestbuffers request{};
    request.count = wanted_buffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = code_of(memory);
    if (const int error = device_->request(VIDIOC_REQBUFS, &request); error != 0) return error;
    memory_ = memory;
    allocate(request.count);
    return 0;
}

void BufferQueue::allocate(std::uint32_t count) {
    for (std::uint32_t k = 0; k < count; ++k) {
        if (memory_ == Memory::user) {
            const std::size_t bytes = (frame_bytes_ + page_bytes - 1) / page_bytes * page_bytes;
            auto* start = static_cast<std::byte*>(std::aligned_alloc(page_bytes, bytes));
            if (start == nullptr) throw std::bad_alloc();
            buffers_.emplace_back(start, Unmap{bytes, memory_});
            continue;
        }
        v4l2_buffer buffer = description_of(memory_, k);
        if (const int error = device_->request(VIDIOC_QUERYBUF, &buffer); error != 0)
            throw RunFault(device_->refusal("a buffer cannot be had (VIDIOC_QUERYBUF)", error));
        void* start = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_->fd(),
                             static_cast<off_t>(buffer.m.offset));
        if (start == MAP_FAILED)  // NOLINT(performance-no-int-to-ptr): the system's macro
            throw RunFault(device_->refusal("a buffer cannot be mapped", errno));
        buffers_.emplace_back(static_cast<std::byte*>(start), Unmap{buffer.length, memory_});
    }
}

void BufferQueue::start_stream() {
    for (std::uint32_t k = 0; k < buffers_.size(); ++k)
        if (const int error = queue(k); error != 0)
            throw RunFault(device_->refusal("a buffer is refused (VIDIOC_QBUF)", error));
    auto type = static_cast<int>(V4L2_BUF_TYPE_VIDEO_CAPTURE);
    if (const int error = device_->request(VIDIOC_STREAMON, &type); error != 0)
        throw RunFault(device_->refusal("the camera does not start to stream (VIDIOC_STREAMON)", error));
}

int BufferQueue::queue(std::uint32_t index) {
    v4l2_buffer buffer = description_of(memory_, index);
    if (memory_ == Memory::user) {
        buffer.m.userptr = reinterpret_cast<unsigned long>(buffers_[index].get());
        buffer.length = static_cast<std::uint32_t>(buffers_[index].get_deleter().bytes);
    }
    const int error = device_->request(VIDIOC_QBUF, &buffer);
    if (error == 0) ++with_driver_;
    return error;
}

Result<std::optional<Lease>> BufferQueue::take() {
    v4l2_buffer buffer = description_of(memory_, 0);
    const int error = device_->request(VIDIOC_DQBUF, &buffer);
    if (error == EAGAIN) return std::optional<Lease>();
    if (error != 0)
        return failure(Reason::device, device_->refusal("no frame can be had (VIDIOC_DQBUF)", error));
    FIDSERVO_DEMAND(buffer.index < buffers_.size());
    const std::lock_guard lock(mutex_);
    --with_driver_;
    const std::size_t most_bytes = buffers_[buffer.index].get_deleter().bytes;
    return std::optional<Lease>(
        std::in_place, shared_from_this(),
        FilledBuffer{buffer.index, std::min<std::size_t>(buffer.bytesused, most_bytes), buffer.sequence,
                     (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0, stamp_of(buffer)});
}

void BufferQueue::give_back(std::uint32_t index) {
    const std::lock_guard lock(mutex_);
    if (device_) (void)queue(index);  // a camera that refuses has gone: take() says so
}

void BufferQueue::stop() {
    const std::lock_guard lock(mutex_);
    if (!device_) return;
    auto type = static_cast<int>(V4L2_BUF_TYPE_VIDEO_CAPTURE);
    (void)device_->request(VIDIOC_STREAMOFF, &type);
    device_.reset();
    with_driver_ = 0;
}

std::size_t BufferQueue::with_driver() const {
    const std::lock_guard lock(mutex_);
    return with_driver_;
}

Lease::~Lease() {
    if (queue_) queue_->give_back(filled_.index);
}

Lease& Lease::operator=(Lease&& other) noexcept {
    if (this == &other) return *this;
    if (queue_) queue_->give_back(filled_.index);
    queue_ = std::move(other.queue_);
    filled_ = other.filled_;
    return *this;
}

std::span<const std::byte> Lease::bytes() const {
    return {queue_->buffers_[filled_.index].get(), filled_.used_bytes};
}

}  // namespace fidservo::vision::v4l2
