#include "vision/edge_fit.h"

#include "vision/normal_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace fidservo::vision {
namespace {

constexpr int parameters = 6;
using Vector6 = Eigen::Matrix<double, parameters, 1>;
using Matrix6 = Eigen::Matrix<double, parameters, parameters>;
enum Parameter { offset, slope, black, white, light, blur };

constexpr double least_blur_px = 0.25;
constexpr double usual_blur_px = 0.8;
constexpr double most_blur_px = 4.0;
constexpr double least_contrast = 8.0;  ///< grey levels; below, noise decides where the edge is
constexpr int least_cross_sections = 5;
constexpr double blur_std_px = 0.3;  ///< prior, for edges whose few pixels do not tell the blur
constexpr double grey_std = 2.0;     ///< noise to weigh the prior by
constexpr double blur_prior_weight = grey_std * grey_std / (blur_std_px * blur_std_px);
constexpr double outlier_ratio = 6.0;  ///< mean square of a cross section against the median one's
constexpr double outlier_floor = 9.0;  ///< grey levels squared: never an outlier below

struct EdgePixel {
    double t, d;
    double grey;
};

/// Pixels of one image row or column across the edge.
struct CrossSection {
    std::size_t begin, end;  ///< into the pixels
    bool used = true;
};

struct Strip {
    std::vector<EdgePixel> pixels;
    std::vector<CrossSection> sections;
    bool inside = true;
};

/// Raw pixels within the strip, cross section by cross section, along whichever image axis is nearer to the
/// edge's direction.
Strip collect(const cv::Mat& image, const EdgeGuess& guess) {
    const bool steep = std::abs(guess.along.y()) > std::abs(guess.along.x());
    const int main = steep ? 1 : 0;
    const int cross = 1 - main;
    const int main_size = steep ? image.rows : image.cols;
    const int cross_size = steep ? image.cols : image.rows;
    const double reach = 0.5 * guess.length_px * std::abs(guess.along[main]);
    const double widen = guess.half_width_px / std::abs(guess.along[main]);
    const int first = static_cast<int>(std::ceil(guess.middle_px[main] - reach));
    const int last = static_cast<int>(std::floor(guess.middle_px[main] + reach));

    Strip strip;
    if (first > last) return strip;
    if (first < 0 || last >= main_size) return {{}, {}, false};
    strip.sections.reserve(last - first + 1);
    strip.pixels.reserve((last - first + 1) * static_cast<std::size_t>(2 * widen + 2));
    for (int m = first; m <= last; ++m) {
        const double on_edge =
            guess.middle_px[cross] + (m - guess.middle_px[main]) * guess.along[cross] / guess.along[main];
        const int low = static_cast<int>(std::ceil(on_edge - widen));
        const int high = static_cast<int>(std::floor(on_edge + widen));
        if (low < 0 || high >= cross_size) return {{}, {}, false};
        const std::size_t begin = strip.pixels.size();
        for (int c = low; c <= high; ++c) {
            const Eigen::Vector2d at = steep ? Eigen::Vector2d(c, m) : Eigen::Vector2d(m, c);
            const Eigen::Vector2d from_middle = at - guess.middle_px;
            const double grey = steep ? image.at<unsigned char>(m, c) : image.at<unsigned char>(c, m);
            strip.pixels.push_back({from_middle.dot(guess.along), from_middle.dot(guess.normal), grey});
        }
        strip.sections.push_back({begin, strip.pixels.size()});
    }
    return strip;
}

const NormalTable standard_normal;

/// Model minus pixel, and its derivatives to the parameters.
double residual(const Vector6& p, const EdgePixel& pixel, Vector6& jacobian) {
    const double z = (pixel.d - p[offset] - p[slope] * pixel.t) / p[blur];
    const auto [part, unit_density] = standard_normal(z);
    const double height = p[white] + p[light] * pixel.t - p[black];
    const double density = height * unit_density / p[blur];
    jacobian << -density, -density * pixel.t, 1 - part, part, part * pixel.t, -density * z;
    return p[black] + height * part - pixel.grey;
}

struct NormalEquations {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    Matrix6 scatter = Matrix6::Zero();  ///< sum of r^2 J J^T: the middle of the sandwich
};

/// Sums over every n-th cross section in use, the prior on the blur included.
template <bool with_scatter>
NormalEquations accumulate(const Strip& strip, const Vector6& p, std::size_t every) {
    NormalEquations sums;
    Vector6 jacobian;
    for (std::size_t k = 0; k < strip.sections.size(); k += every) {
        if (!strip.sections[k].used) continue;
        for (std::size_t i = strip.sections[k].begin; i < strip.sections[k].end; ++i) {
            const double r = residual(p, strip.pixels[i], jacobian);
            sums.normal.noalias() += jacobian * jacobian.transpose();
            sums.right.noalias() -= jacobian * r;
            if constexpr (with_scatter) sums.scatter.noalias() += (r * r) * jacobian * jacobian.transpose();
        }
    }
    sums.normal(blur, blur) += blur_prior_weight;
    sums.right[blur] += blur_prior_weight * (usual_blur_px - p[blur]);
    return sums;
}

/// Gauss-Newton with bounded steps. True if it came to rest.
bool iterate(const Strip& strip, const EdgeGuess& guess, std::size_t every, int most_steps, Vector6& p) {
    constexpr double at_rest_px = 5e-4;  // of the last step; what is left after it is far less
    for (int step = 0; step < most_steps; ++step) {
        const NormalEquations sums = accumulate<false>(strip, p, every);
        const Vector6 change = sums.normal.ldlt().solve(sums.right);
        if (!change.allFinite()) return false;
        const double bound = std::min(1.0, 1.0 / std::max(std::abs(change[offset]), 1e-12));
        p[offset] += bound * change[offset];
        p[slope] += bound * change[slope];
        p.segment<3>(black) += change.segment<3>(black);
        p[blur] = std::clamp(p[blur] + std::clamp(change[blur], -0.5 * p[blur], 0.5 * p[blur]), least_blur_px,
                             most_blur_px);
        if (std::abs(p[offset]) > guess.half_width_px) return false;
        if (std::abs(change[offset]) < at_rest_px && std::abs(change[slope]) * guess.length_px < at_rest_px)
            return true;
    }
    return false;
}

/// Marks cross sections that do not look like the edge; returns the share that does.
double reject_outliers(Strip& strip, const Vector6& p) {
    Vector6 jacobian;
    std::vector<double> mean_square;
    mean_square.reserve(strip.sections.size());
    for (const CrossSection& section : strip.sections) {
        double sum = 0.0;
        for (std::size_t i = section.begin; i < section.end; ++i) {
            const double r = residual(p, strip.pixels[i], jacobian);
            sum += r * r;
        }
        mean_square.push_back(sum / static_cast<double>(section.end - section.begin));
    }
    std::vector<double> sorted = mean_square;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    const double limit = std::max(outlier_ratio * sorted[sorted.size() / 2], outlier_floor);
    std::size_t used = 0;
    for (std::size_t k = 0; k < strip.sections.size(); ++k) {
        strip.sections[k].used = mean_square[k] <= limit;
        used += strip.sections[k].used ? 1 : 0;
    }
    return static_cast<double>(used) / static_cast<double>(strip.sections.size());
}

/// Levels as the medians of the strip's outer quarters.
Vector6 start(const Strip& strip, const EdgeGuess& guess) {
    std::vector<double> dark;
    std::vector<double> bright;
    for (const EdgePixel& pixel : strip.pixels) {
        if (pixel.d < -0.5 * guess.half_width_px) dark.push_back(pixel.grey);
        if (pixel.d > 0.5 * guess.half_width_px) bright.push_back(pixel.grey);
    }
    const auto median = [](std::vector<double>& of) {
        if (of.empty()) return 0.0;
        std::nth_element(of.begin(), of.begin() + of.size() / 2, of.end());
        return of[of.size() / 2];
    };
    Vector6 p = Vector6::Zero();
    p[black] = median(dark);
    p[white] = median(bright);
    p[blur] = usual_blur_px;
    return p;
}

}  // namespace

Result<EdgeFit> fit_edge(const cv::Mat& image, const EdgeGuess& guess) {
    Strip strip = collect(image, guess);
    if (!strip.inside) return failure(Reason::occluded, "an edge of the tag leaves the image");
    if (strip.sections.size() < least_cross_sections)
        return failure(Reason::occluded, "the tag is too small for its edges to be measured");
    Vector6 p = start(strip, guess);
    const auto no_edge = [] { return failure(Reason::occluded, "an edge of the tag is not there"); };
    if (p[white] - p[black] < least_contrast) return no_edge();

    const std::size_t coarse = std::max<std::size_t>(1, strip.sections.size() / 60);
    iterate(strip, guess, coarse, 12, p);
    double explained = reject_outliers(strip, p);
    if (explained < 0.5 || !iterate(strip, guess, 1, 12, p)) return no_edge();
    if (explained < 1.0) {  // what lay over the edge has pulled at the first fit
        explained = reject_outliers(strip, p);
        if (explained < 0.5 || !iterate(strip, guess, 1, 6, p)) return no_edge();
    }
    if (p[white] - p[black] < least_contrast) return no_edge();

    const NormalEquations sums = accumulate<true>(strip, p, 1);
    const Matrix6 inverse = sums.normal.ldlt().solve(Matrix6::Identity());
    const Matrix6 covariance = inverse * sums.scatter * inverse;
    return EdgeFit{p[offset], p[slope], covariance.topLeftCorner<2, 2>(), p[blur], p[black],
                   p[white],  explained};
}

}  // namespace fidservo::vision
