// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where an edge crosses, from grey values at known distances from its presumed place. No interpolation: the
// samples are pixels, so their noise is independent and the uncertainty that follows from it is exact to
// first order.
#include "core/result.h"
#include "vision/grey_noise.h"

#include <span>

namespace fidservo::vision {

/// A pixel: distance of its centre from the presumed edge along the normal, and its grey value.
struct EdgeSample {
    double t_px;
    double grey;
};

/// What is known of the blur beforehand: the optical blur's standard deviation, and how well it is known.
struct BlurPrior {
    double blur_px;
    double std_px;  ///< 0: exactly
};

/// Standard deviation of an edge's profile: optical blur and the pixel's own square, whose variance is 1/12
/// px^2 in every direction.
double edge_sigma_px(double blur_px);
/// The inverse; 0 where the edge is sharper than a pixel allows.
double optical_blur_px(double edge_sigma_px);

struct EdgeFit {
    double position_px;      ///< of the edge along t
    double position_std_px;  ///< Fisher information, levels and blur being unknown too
    double low_side_grey;    ///< level at t below the edge
    double high_side_grey;   ///< level at t above it
    double sigma_px;         ///< of the profile
    double chi2;             ///< sum of squared residuals over their variance
    int degrees_of_freedom;
};

/// Maximum likelihood of  g(t) = low + (high - low) Phi((t - position) / sigma),  clipped at white, with
/// noise that grows with the level. Fails with not_identifiable (too few samples, edge outside them, no
/// contrast), glare (a level is saturated) or no_convergence.
Result<EdgeFit> locate_edge(std::span<const EdgeSample> samples, const GreyNoise& noise,
                            const BlurPrior& blur);

/// What is known beforehand of a strip between two edges.
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
///     g(t) = L(t) (1 - contrast (Phi((t - a) / sigma) - Phi((t - b) / sigma))),   a, b = centre -+ width /
///     2,
/// L linear in t. Holds for strips thinner than the blur too, where the prior of contrast and blur decides.
/// Failures as for locate_edge.
Result<StripFit> locate_strip(std::span<const EdgeSample> samples, const GreyNoise& noise,
                              const StripPrior& prior);

}  // namespace fidservo::vision
