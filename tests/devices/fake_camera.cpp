// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/devices/fake_camera.h"

#include "tests/devices/fake_state.h"

#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <umockdev.h>
#include <unistd.h>

namespace fidservo::devices {

namespace {

void update(UMockdevIoctlData* data, const std::vector<std::byte>& bytes) {
    std::vector<std::byte> copy = bytes;
    umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(copy.data()),
                               static_cast<gint>(copy.size()));
}

/// The test bed, whose own thread serves its node. One for the program: umockdev redirects the whole process.
class Bed {
  public:
    static Bed& instance() {
        static Bed bed;
        return bed;
    }

    void plug(std::shared_ptr<FakeCamera::State> state) {
        const std::lock_guard lock(mutex_);
        if (state) state->node_fd = node_fd_;
        state_ = std::move(state);
    }

    std::shared_ptr<FakeCamera::State> state() const {
        const std::lock_guard lock(mutex_);
        return state_;
    }

  private:
    Bed() : bed_(umockdev_testbed_new()), handler_(umockdev_ioctl_base_new()) {
        GError* error = nullptr;
        constexpr const char* device =
            "P: /devices/virtual/video4linux/video0\nN: video0=00\nS: "
            "v4l/by-id/usb-Fake_camera-video-index0\n"
            "E: DEVNAME=/dev/video0\nE: SUBSYSTEM=video4linux\nA: name=Fake camera\\n\nA: dev=81:0\\n\n";
        umockdev_testbed_add_from_string(bed_, device, &error);
        g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&Bed::on_request), this);
        if (error == nullptr) umockdev_testbed_attach_ioctl(bed_, "/dev/video0", handler_, &error);
        gchar* root = umockdev_testbed_get_root_dir(bed_);
        node_fd_ = ::open((std::string(root) + "/dev/video0").c_str(), O_RDWR | O_CLOEXEC);
        g_free(root);
        if (error != nullptr || node_fd_ < 0 || ::ftruncate(node_fd_, most_buffers * buffer_stride) != 0)
            throw std::runtime_error(error != nullptr ? error->message : "the fake node cannot be opened");
    }

    ~Bed() {
        ::close(node_fd_);
        g_object_unref(bed_);
        g_object_unref(handler_);
    }

    static gboolean on_request(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
        const gulong request = umockdev_ioctl_client_get_request(client);
        const std::size_t bytes = _IOC_SIZE(request);
        GError* error = nullptr;
        UMockdevIoctlData* data =
            umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, bytes, &error);
        if (data == nullptr) {
            umockdev_ioctl_client_complete(client, -1, EFAULT);
            return TRUE;
        }
        std::vector<std::byte> argument(bytes);
        std::memcpy(argument.data(), data->data, bytes);
        const Pointed pointed{
            [data](std::size_t at, std::vector<std::byte>& copy) {
                UMockdevIoctlData* there = umockdev_ioctl_data_resolve(data, at, copy.size(), nullptr);
                if (there != nullptr) std::memcpy(copy.data(), there->data, copy.size());
                return there != nullptr;
            },
            [data](std::size_t at, const std::vector<std::byte>& copy) {
                UMockdevIoctlData* there = umockdev_ioctl_data_resolve(data, at, copy.size(), nullptr);
                if (there != nullptr) update(there, copy);
                return there != nullptr;
            }};
        const auto state = static_cast<Bed*>(self)->state();
        const int refused = state ? state->answer(request, argument, pointed) : ENODEV;
        const bool points = request == VIDIOC_G_EXT_CTRLS || request == VIDIOC_S_EXT_CTRLS;
        if (refused == 0 && !points && (_IOC_DIR(request) & _IOC_READ) != 0) update(data, argument);
        umockdev_ioctl_client_complete(client, refused == 0 ? 0 : -1, refused);
        return TRUE;
    }

    mutable std::mutex mutex_;
    std::shared_ptr<FakeCamera::State> state_;
    UMockdevTestbed* bed_;
    UMockdevIoctlBase* handler_;
    int node_fd_ = -1;
};

}  // namespace

FakeCamera::FakeCamera(FakeProperties properties) : state_(std::make_shared<State>(std::move(properties))) {
    Bed::instance().plug(state_);
}

FakeCamera::~FakeCamera() {
    Bed::instance().plug(nullptr);
}

void FakeCamera::expose(FakeFrame frame) {
    const std::lock_guard lock(state_->mutex);
    if (state_->exposed.size() < state_->queued.size())
        state_->exposed.push_back(std::move(frame));
    else
        ++state_->dropped;
}

std::size_t FakeCamera::waiting() const {
    const std::lock_guard lock(state_->mutex);
    return state_->exposed.size();
}

std::size_t FakeCamera::queued_buffers() const {
    const std::lock_guard lock(state_->mutex);
    return state_->queued.size();
}

std::size_t FakeCamera::dropped() const {
    const std::lock_guard lock(state_->mutex);
    return state_->dropped;
}

void FakeCamera::unplug() {
    const std::lock_guard lock(state_->mutex);
    state_->unplugged = true;
    state_->exposed.clear();
    state_->queued.clear();
}

void FakeCamera::plug_in() {
    const std::lock_guard lock(state_->mutex);
    state_->unplugged = false;
}

void FakeCamera::change_format(const FakeFormat& format) {
    const std::lock_guard lock(state_->mutex);
    state_->current.width = static_cast<std::uint32_t>(format.width_px);
    state_->current.height = static_cast<std::uint32_t>(format.height_px);
    state_->current.pixelformat = format.fourcc;
}

std::int64_t FakeCamera::control(std::uint32_t id) const {
    const std::lock_guard lock(state_->mutex);
    for (const FakeControl& control : state_->properties.controls)
        if (control.id == id) return control.value;
    throw std::out_of_range("no such control");
}

}  // namespace fidservo::devices
