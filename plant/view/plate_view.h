// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The plate as the camera sees it.
#include "core/camera/camera_parameters.h"
#include "core/plate.h"
#include "plant/camera.h"
#include "plant/view/view_options.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::plant {

/// Renders frames of a plate. The reflectance at a pixel is the printed pattern, blurred by the lens,
/// averaged over the pixel's area and over the motion during the exposure; multiplied by the light it is the
/// mean signal, to which the sensor adds shot and read noise before it rounds to 8 bit. Edges are painted
/// from profiles over continuous distance, so that a shift of 0.01 px appears as such.
///
/// Things that overlap are composed as R <- R + coverage (reflectance - R) with blurred coverages; that is
/// exact wherever their edges are further than the blur from each other, or cross at a right angle.
///
/// Immutable; render() and expose() may be called from several threads.
class PlateView {
  public:
    /// The camera's true position in mm (macro + micro), as a function of the time in s after the frame's
    /// time.
    using Path = std::function<double(double after_s)>;

    /// @param deviation  how the camera deviates from its parameters
    /// Throws InputError for a tag that is not in the code book and for a shape without an area.
    PlateView(const CameraParameters& camera, const Plate& plate, const ViewOptions& options,
              const CameraDeviation& deviation = {});
    ~PlateView();
    /// Leaves the other one empty.
    PlateView(PlateView&&) noexcept;
    /// Leaves the other one empty.
    PlateView& operator=(PlateView&&) noexcept;

    /// The frame number `frame`, CV_8UC1, pixel centres at integer coordinates.
    /// @param s_mm  the camera's true positions (macro + micro) over the exposure, evenly spaced, both ends
    ///              included; one position stands for a camera at rest
    /// The noise is a pure function of (seed, frame): the same call gives the same bytes.
    cv::Mat render(std::span<const double> s_mm, std::uint64_t frame) const;

    /// The frame of a camera in motion: the path is sampled over the exposure, row by row for a rolling
    /// shutter.
    /// @param time_s  the frame's time, for the camera's formulas
    cv::Mat expose(const Path& path, std::uint64_t frame, double time_s = 0.0) const;

    /// How long before and after a frame's time expose() evaluates the path, s.
    double reach_s() const;

  private:
    struct Impl;
    explicit PlateView(std::unique_ptr<const Impl> impl);
    std::unique_ptr<const Impl> impl_;
};

}  // namespace fidservo::plant
