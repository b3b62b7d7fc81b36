// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Subpixel position of an edge, from the grey values of pixels at known distances from its presumed place.
// Nothing is interpolated: the samples are pixels, so their noise is independent and the uncertainty that
// follows from it is exact to first order.
#include "core/result.h"
#include "vision/grey_noise.h"

#include <span>

namespace fidservo::vision {

/// A pixel: distance of its centre from the presumed edge along the normal, and its grey value.
struct EdgeSample {
    double t_px;
    double grey;
};

/// Prior knowledge of the blur: the optical blur's standard deviation, and that value's own standard
/// deviation.
struct BlurPrior {
    double blur_px;
    double std_px;  ///< 0: blur_px is exact
};

/// Standard deviation of an edge's profile: optical blur and the pixel's own square, whose variance is 1/12
/// px^2 in every direction.
double edge_sigma_px(double blur_px);
/// The inverse of edge_sigma_px(); 0 where the edge is sharper than a pixel allows.
double optical_blur_px(double edge_sigma_px);

struct EdgeFit {
    double position_px;      ///< of the edge along t
    double position_std_px;  ///< from the Fisher information, with levels and blur unknown too
    double low_side_grey;    ///< level on the side of smaller t
    double high_side_grey;   ///< level on the side of larger t
    double sigma_px;         ///< standard deviation of the profile
    double chi2;             ///< sum of squared residuals over their variance
    int degrees_of_freedom;
};

/// Maximum likelihood of  g(t) = low + (high - low) Phi((t - position) / sigma),  clipped at white, with
/// noise that grows with the level. Fails with not_identifiable (too few samples, edge outside them, no
/// contrast), glare (a level is saturated) or no_convergence.
Result<EdgeFit> locate_edge(std::span<const EdgeSample> samples, const GreyNoise& noise,
                            const BlurPrior& blur);

/// Prior knowledge of a strip between two edges.
struct StripPrior {
    BlurPrior blur;
    double centre_px, centre_std_px;
    double contrast;  ///< 1 - inside / outside level
    double contrast_std;
};

struct StripFit {
    double centre_px, centre_std_px;
    double width_px, width_std_px;  ///< may come out slightly negative where there is no strip
    double outside_grey;            ///< level beside the strip, at t = 0
    double contrast;
    double sigma_px;
    double chi2;
    int degrees_of_freedom;
};

/// Maximum likelihood of two edges at once,
///     g(t) = L(t) (1 - contrast (Phi((t - a) / sigma) - Phi((t - b) / sigma))),
///     a, b = centre -+ width / 2,   L linear in t.
/// Valid also for strips thinner than the blur, for which the prior of contrast and blur decides.
/// Failures as for locate_edge.
Result<StripFit> locate_strip(std::span<const EdgeSample> samples, const GreyNoise& noise,
                              const StripPrior& prior);

}  // namespace fidservo::vision
