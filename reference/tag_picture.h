// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Frames of the fiducial nearest to the image centre, seen by a camera that looks straight down.
//
// A pixel of row v is the mean over the exposure, about t_v, of
//
//     R = paper + (ink - paper) sum over black cells (i, j) of A_i(u, t) B_j(v),   t_v = readout (v / (h - 1)
//     - 1/2)
//
// A_i is the fraction of pixel u covered by column i of the tag, as seen at time t; B_j that of pixel v
// covered by row j. For a tag parallel to the pixels they are exact: the lens is a Gaussian of deviation s,
// so that an edge at e gives pixel u
//
//     G(u + 1/2 - e) - G(u - 1/2 - e),   G(z) = z Phi(z / s) + s phi(z / s)
//
// and a column the difference of its two edges. Out of focus, s is larger, or a convolution with a disc
// follows. Then come the illumination and the sensor: shot noise, read noise, unequal gains, rounding to 8
// bit.
#include "core/camera/camera_parameters.h"
#include "core/fiducial_parameters.h"
#include "core/random.h"
#include "reference/departures.h"

#include <functional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::reference {

/// The cells of a tag, 1 for black; rows from the top of the image.
using TagCells = Eigen::Matrix<double, 8, 8>;

/// The cells of a tag of the usual family (core/tag_families.h).
TagCells usual_cells(int tag_id);

struct PictureModel {
    CameraParameters camera;
    FiducialParameters fiducials;
    ImageDepartures departures;
    std::function<TagCells(int tag_id)> cells;
};

/// The camera's position at a time in s after the middle of the exposure, mm.
using CameraWay = std::function<double(double after_s)>;

/// Fixed gains of the pixels, CV_32F, of the image's size; empty if all of them are 1.
cv::Mat pixel_gains(const PictureModel& model, std::uint64_t seed);

struct Picture {
    cv::Mat image;       ///< CV_8UC1, of the camera's size; uniform grey outside region_px
    cv::Rect region_px;  ///< the part that was rendered: the tag and white paper around it
};

/// Demands a camera that is neither rotated nor tilted and has no distortion.
Picture picture_of(const PictureModel& model, const CameraWay& s_mm, const cv::Mat& gains,
                   NoiseStream& noise);

}  // namespace fidservo::reference
