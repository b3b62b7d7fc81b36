#pragma once
// The boundary to a camera: V4L2, simulated, or images on disk.
#include "core/failure.h"
#include "core/time.h"

#include <cstdint>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

struct Frame {
    cv::Mat image;          ///< CV_8UC1
    TimeNs time_ns = 0;     ///< middle of the exposure
    TimeNs arrival_ns = 0;  ///< when the program could first have it
    std::uint64_t sequence = 0;
    std::string source;  ///< file name, where there is one
};

class Camera {
  public:
    Camera() = default;
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;
    virtual ~Camera() = default;

    /// The newest frame that has arrived by now_ns and was not handed out before; empty if there is none.
    /// Fails with Reason::device.
    virtual Result<std::optional<Frame>> poll(TimeNs now_ns) = 0;
};

}  // namespace fidservo::vision
