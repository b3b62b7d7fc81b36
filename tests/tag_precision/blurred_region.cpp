// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/blurred_region.h"

#include "core/demand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fidservo::precision {
namespace {

constexpr double reach_sigma = 6.2;  // leaves 3e-10 of the light out

double normal_density(double z) {
    return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

double normal_share(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// Integral of the normal distribution function up to x, and its integral again.
double ramp(double x, double sigma) {
    return x * normal_share(x / sigma) + sigma * normal_density(x / sigma);
}

double parabola(double x, double sigma) {
    return 0.5 * ((x * x + sigma * sigma) * normal_share(x / sigma) + x * sigma * normal_density(x / sigma));
}

/// ky: the share of the light from y = z that falls into the pixel at 0.
double pixel_kernel(double z, double sigma) {
    return normal_share((z + 0.5) / sigma) - normal_share((z - 0.5) / sigma);
}

/// K: the share of a half plane x < z that the pixel at 0 sees.
double pixel_step(double z, double sigma, double motion_px) {
    if (motion_px == 0.0) return ramp(z + 0.5, sigma) - ramp(z - 0.5, sigma);
    const double h = 0.5 * motion_px;
    return (parabola(z + 0.5 + h, sigma) - parabola(z + 0.5 - h, sigma) - parabola(z - 0.5 + h, sigma) +
            parabola(z - 0.5 - h, sigma)) /
           motion_px;
}

/// A function at z, z - 1, z - 2, ... at once: cubic interpolation between tabulated phases of z.
class PhaseTable {
  public:
    template <class Function>
    PhaseTable(double reach_px, Function function)
        : reach_(static_cast<int>(std::ceil(reach_px)) + 1), count_(2 * reach_ + 1) {
        values_.resize(static_cast<std::size_t>((phases + 3) * count_));
        for (int p = 0; p < phases + 3; ++p)
            for (int k = 0; k < count_; ++k)
                values_[static_cast<std::size_t>(p * count_ + k)] =
                    function(static_cast<double>(p - 1) / phases + reach_ - k);
    }

    int count() const { return count_; }

    /// f(x - u) of the pixels u = first, first + 1, ..., `count()` of them; returns first.
    int evaluate(double x, double* out) const {
        const double whole = std::floor(x);
        const double place = (x - whole) * phases;
        const int p = std::min(static_cast<int>(place), phases - 1);
        const double t = place - p;
        const std::array weights{-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                                 -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
        const double* row = &values_[static_cast<std::size_t>(p * count_)];
        for (int k = 0; k < count_; ++k)
            out[k] = weights[0] * row[k] + weights[1] * row[k + count_] + weights[2] * row[k + 2 * count_] +
                     weights[3] * row[k + 3 * count_];
        return static_cast<int>(whole) - reach_;
    }

  private:
    static constexpr int phases = 128;
    int reach_, count_;
    std::vector<double> values_;
};

/// Differences of the coverage from pixel to pixel along u, on a frame that holds all of the boundary.
class Differences {
  public:
    Differences(const std::vector<BoundaryEdge>& edges, double sigma_px, double motion_px)
        : step_px_(1.25 * sigma_px),
          along_u_(reach_sigma * sigma_px + 1.5 + 0.5 * motion_px,
                   [=](double z) {
                       return pixel_step(z, sigma_px, motion_px) - pixel_step(z + 1.0, sigma_px, motion_px);
                   }),
          along_v_(reach_sigma * sigma_px + 0.5, [=](double z) { return pixel_kernel(z, sigma_px); }) {
        Eigen::Vector2d low = edges.front().from_px, high = low;
        for (const BoundaryEdge& edge : edges) {
            low = low.cwiseMin(edge.from_px).cwiseMin(edge.to_px);
            high = high.cwiseMax(edge.from_px).cwiseMax(edge.to_px);
        }
        first_u_ = static_cast<int>(std::floor(low.x())) - along_u_.count();
        first_v_ = static_cast<int>(std::floor(low.y())) - along_v_.count();
        sums_ = cv::Mat1d(static_cast<int>(std::ceil(high.y())) + along_v_.count() - first_v_ + 1,
                          static_cast<int>(std::ceil(high.x())) + along_u_.count() - first_u_ + 1, 0.0);
        for (const BoundaryEdge& edge : edges) add(edge);
    }

    /// Adds share times the coverage to an image.
    void integrate_into(cv::Mat1d& image, double share) const {
        for (int row = 0; row < sums_.rows; ++row) {
            const int v = row + first_v_;
            if (v < 0 || v >= image.rows) continue;
            double sum = 0.0;
            for (int column = 0; column < sums_.cols; ++column) {
                sum += sums_(row, column);
                const int u = column + first_u_;
                if (u >= 0 && u < image.cols) image(v, u) += share * sum;
            }
        }
    }

  private:
    /// Gauss's rule of four points on stretches not longer than the blur.
    void add(const BoundaryEdge& edge) {
        constexpr std::array nodes{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                   0.8611363115940526};
        constexpr std::array weights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                     0.3478548451374538};
        const Eigen::Vector2d whole = edge.to_px - edge.from_px;
        if (whole.y() == 0.0) return;
        const int stretches = std::max(1, static_cast<int>(std::ceil(whole.norm() / step_px_)));
        for (int k = 0; k < stretches; ++k)
            for (std::size_t n = 0; n < nodes.size(); ++n)
                add_point(edge.from_px + whole * ((k + 0.5 + 0.5 * nodes[n]) / stretches),
                          edge.weight * 0.5 * weights[n] * whole.y() / stretches);
    }

    void add_point(const Eigen::Vector2d& at_px, double weight) {
        std::array<double, longest> by_u;
        std::array<double, longest> by_v;
        FIDSERVO_DEMAND(along_u_.count() <= longest && along_v_.count() <= longest);
        const int u = along_u_.evaluate(at_px.x(), by_u.data()) - first_u_;
        const int v = along_v_.evaluate(at_px.y(), by_v.data()) - first_v_;
        for (int j = 0; j < along_v_.count(); ++j) {
            double* row = &sums_(v + j, u);
            const double factor = weight * by_v[static_cast<std::size_t>(j)];
            for (int i = 0; i < along_u_.count(); ++i) row[i] += factor * by_u[static_cast<std::size_t>(i)];
        }
    }

    static constexpr int longest = 256;
    double step_px_;
    PhaseTable along_u_, along_v_;
    int first_u_ = 0, first_v_ = 0;
    cv::Mat1d sums_;
};

}  // namespace

double Blur::standard_deviation_px() const {
    return std::sqrt((1.0 - halo_share) * sigma_px * sigma_px + halo_share * halo_sigma_px * halo_sigma_px);
}

cv::Mat1d coverage(const std::vector<BoundaryEdge>& edges, const Blur& blur, cv::Size size_px) {
    cv::Mat1d image(size_px, 0.0);
    if (edges.empty()) return image;
    Differences(edges, blur.sigma_px, blur.motion_px).integrate_into(image, 1.0 - blur.halo_share);
    if (blur.halo_share > 0.0)
        Differences(edges, blur.halo_sigma_px, blur.motion_px).integrate_into(image, blur.halo_share);
    return image;
}

std::vector<BoundaryEdge> edges_of(const std::vector<Eigen::Vector2d>& polygon_px) {
    std::vector<BoundaryEdge> edges;
    for (std::size_t k = 0; k < polygon_px.size(); ++k)
        edges.push_back({polygon_px[k], polygon_px[(k + 1) % polygon_px.size()]});
    return edges;
}

}  // namespace fidservo::precision
