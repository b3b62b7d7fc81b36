// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fixes exposure, gain and focus: measurements must not depend on the camera's automatic controls.
#include "vision/v4l2/capture_settings.h"
#include "vision/v4l2/device.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::vision::v4l2 {

struct LockedControl {
    std::string name;  ///< as the driver names it
    std::int64_t value;
};

struct ControlLock {
    std::vector<LockedControl> locked;  ///< the controls with the values read back
    std::optional<double> exposure_s;   ///< the exposure in force; empty: the camera does not let it be set
};

/// Switches off every automatic control that the camera has (exposure, frame rate by exposure, gain, focus,
/// white balance), sets exposure, gain and focus, and reads all of them back. Exposures are in units of 100
/// us and rounded to them. Gain and focus that are not given stay as they are. Throws InputError for a value
/// that the camera does not allow, or for a gain or focus that it cannot set; RunFault if a control reads
/// back another value than it was set to.
ControlLock lock_controls(const Device& device, const CaptureSettings& settings);

}  // namespace fidservo::vision::v4l2
