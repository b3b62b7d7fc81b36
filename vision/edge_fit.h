#pragma once
// One straight edge between black and white, fitted to the raw pixels around it.
#include "core/failure.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Where an edge is believed to be. White lies on the side of `normal`.
struct EdgeGuess {
    Eigen::Vector2d middle_px;
    Eigen::Vector2d along;   ///< unit vector
    Eigen::Vector2d normal;  ///< unit vector, perpendicular to `along`, from black to white
    double length_px;        ///< the part to look at, centred on `middle_px`
    double half_width_px;    ///< pixels farther than this from the guess are not looked at
};

/// Points of the edge: middle + t along + (offset + slope t) normal, t in px.
struct EdgeFit {
    double offset_px;
    double slope;
    Eigen::Matrix2d covariance;  ///< of (offset, slope), from the residuals
    double blur_px;              ///< standard deviation of the edge's profile: optics and pixel together
    double black;                ///< grey levels in the middle of the edge
    double white;
    double explained;  ///< share of the edge's length that looks like this edge
};

/// Least squares of  grey = black + (white + light t - black) Phi((d - offset - slope t) / blur)  over raw
/// pixels, with t along and d across the edge from the guess, Phi the normal distribution function. No
/// interpolation takes part, so the result does not lock to the pixel grid. Cross sections that do
/// not fit (something lies over the edge) are dropped and lower `explained`. The covariance is the
/// sandwich estimate: it does not assume that black and white pixels are equally noisy.
/// Fails with Reason::occluded if no edge is there, or if the strip leaves the image.
Result<EdgeFit> fit_edge(const cv::Mat& image, const EdgeGuess& guess);

}  // namespace fidservo::vision
