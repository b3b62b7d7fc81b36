// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a camera offers: pixel formats, image sizes, frame rates.
#include "vision/v4l2/device.h"
#include "vision/v4l2/pixel_format.h"

#include <cstdint>
#include <string>
#include <vector>

struct v4l2_fract;

namespace fidservo::vision::v4l2 {

/// Image sizes: one, or all from the smallest to the largest in steps.
struct OfferedSize {
    int least_width_px, least_height_px;
    int most_width_px, most_height_px;
    int step_width_px = 0, step_height_px = 0;  ///< 0: a single size
    std::vector<double> rates_hz;               ///< of the largest; where a range is offered its ends

    bool is_single() const { return step_width_px == 0; }
    bool includes(int width_px, int height_px) const;
};

struct OfferedFormat {
    std::uint32_t fourcc;
    std::string description;  ///< the driver's
    std::vector<OfferedSize> sizes;
};

/// In the driver's order. A driver that does not say leaves lists empty.
std::vector<OfferedFormat> offered_formats(const Device& device);

/// Of a frame interval; 0 for one that the driver does not know.
double rate_hz(const v4l2_fract& period_s);

/// "640x480", "16x16 to 4096x2160 in steps of 2x2".
std::string size_text(const OfferedSize& size);

}  // namespace fidservo::vision::v4l2
