// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/control_lock.h"

#include "core/input_error.h"
#include "vision/v4l2/controls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

constexpr double exposure_unit_s = 1e-4;

struct Automatic {
    std::uint32_t id;
    std::int64_t off;
};

constexpr std::array automatics{Automatic{V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL},
                                Automatic{V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0},
                                Automatic{V4L2_CID_AUTOGAIN, 0}, Automatic{V4L2_CID_FOCUS_AUTO, 0},
                                Automatic{V4L2_CID_AUTO_WHITE_BALANCE, 0}};

class Locking {
  public:
    explicit Locking(const Device& device) : device_(device) {}

    /// An automatic that cannot be switched off counts as a camera that does not do what it is told.
    void switch_off(const Automatic& automatic) {
        const auto control = find_control(device_, automatic.id);
        if (control && (control->writable || control->value != automatic.off)) set(*control, automatic.off);
    }

    /// @param key  of the rig file's camera, for messages
    void fix(std::uint32_t id, const char* key, std::optional<std::int64_t> value) {
        const auto control = find_control(device_, id);
        if (!control || (value && !control->writable)) {
            if (value)
                throw InputError(fmt::format("camera.{}: {}: {} has no control for it", key, *value,
                                             device_.node().string()));
            return;
        }
        if (!value) {
            if (control->value) wanted_.push_back({*control, *control->value});
            return;
        }
        const std::int64_t step = std::max<std::int64_t>(1, control->step);
        if (*value < control->minimum || *value > control->maximum || (*value - control->minimum) % step != 0)
            throw InputError(fmt::format("camera.{}: {}: {} has \"{}\" from {} to {} in steps of {}", key,
                                         *value, device_.node().string(), control->name, control->minimum,
                                         control->maximum, step));
        set(*control, *value);
    }

    std::vector<LockedControl> read_back() const {
        std::vector<LockedControl> locked;
        for (const auto& [control, value] : wanted_) {
            const auto now = find_control(device_, control.id);
            if (!now || now->value != value)
                throw RunFault(fmt::format("{}: \"{}\" was set to {} and reads back {}",
                                           device_.node().string(), control.name, value,
                                           now && now->value ? std::to_string(*now->value) : "nothing"));
            locked.push_back({control.name, value});
        }
        return locked;
    }

  private:
    struct Wanted {
        Control control;
        std::int64_t value;
    };

    void set(const Control& control, std::int64_t value) {
        if (const int error = set_control(device_, control.id, value); error != 0)
            throw RunFault(
                device_.refusal(fmt::format("\"{}\" cannot be set to {}", control.name, value), error));
        wanted_.push_back({control, value});
    }

    const Device& device_;
    std::vector<Wanted> wanted_;
};

/// The nearest that the control has. Throws InputError for an exposure out of its range.
std::int64_t exposure_units(const Device& device, const Control& control, double exposure_s) {
    const double least_s = static_cast<double>(control.minimum) * exposure_unit_s;
    const double most_s = static_cast<double>(control.maximum) * exposure_unit_s;
    if (exposure_s < least_s - 0.5 * exposure_unit_s || exposure_s > most_s + 0.5 * exposure_unit_s)
        throw InputError(fmt::format("camera.exposure_s: {}: {} exposes from {:.6g} to {:.6g} s", exposure_s,
                                     device.node().string(), least_s, most_s));
    const auto step = static_cast<double>(std::max<std::int64_t>(1, control.step));
    const double steps = std::round((exposure_s - least_s) / (exposure_unit_s * step));
    return control.minimum + std::llround(steps * step);
}

}  // namespace

ControlLock lock_controls(const Device& device, const CaptureSettings& settings) {
    ControlLock lock;
    Locking locking(device);
    for (const Automatic& automatic : automatics) locking.switch_off(automatic);
    if (const auto exposure = find_control(device, V4L2_CID_EXPOSURE_ABSOLUTE);
        exposure && exposure->writable) {
        const std::int64_t units = exposure_units(device, *exposure, settings.exposure_s);
        locking.fix(V4L2_CID_EXPOSURE_ABSOLUTE, "exposure_s", units);
        lock.exposure_s = static_cast<double>(units) * exposure_unit_s;
    }
    const auto gain = find_control(device, V4L2_CID_GAIN) ? V4L2_CID_GAIN : V4L2_CID_ANALOGUE_GAIN;
    locking.fix(gain, "capture.gain", settings.gain);
    locking.fix(V4L2_CID_FOCUS_ABSOLUTE, "capture.focus", settings.focus);
    lock.locked = locking.read_back();
    return lock;
}

}  // namespace fidservo::vision::v4l2
