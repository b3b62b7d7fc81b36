// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Measures the blur, brightness and noise of a tag in its frame.
//
// Every side of the black border is an edge from ink to paper. Along pixel rows (columns, where the side is
// nearer to level) the grey levels g are normalised, G = (g - black) / (white - black), by levels that are
// fitted to strips of ink and of paper on both sides of the edge; they are constant across the edge and
// quadratic along it. (Where the outline is white inside and black outside, ink and paper change places.) The
// differences dG of neighbouring pixels are the slope of the profile, averaged over a pixel's pitch; with q
// their distance from a parabola that is fitted to the edge,
//
//     variance = cos^2 (sum q^2 dG - 1/12) along the edge's normal,
//     with cos that of the angle between normal and row
//
// No shape of the blur is assumed: the variance is that of optics and motion together. Strips begin 3.5
// standard deviations and a pixel from the edge. Source of the moments: Tabatabai, Mitchell, Edge location to
// subpixel values in digital imagery, IEEE Trans. PAMI 6(2), 1984.
#include "core/appearance.h"

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Measures a tag whose corners are known to about a pixel. Blur is measured only up to a standard deviation
/// of 0.11 cells (4 px on the reference rig), at which the profile of an edge fills a cell. A strip in which
/// more than 1 pixel in 200 is at 0 or 255 is saturated, and its side and noise are not measured.
/// @param image  CV_8UC1
TagAppearance tag_appearance(const cv::Mat& image, const TagDetection& tag);

}  // namespace fidservo::vision
