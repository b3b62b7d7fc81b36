// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_pattern.h"

#include "core/normal_equations.h"
#include "vision/tags/quad.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>

namespace fidservo::vision {

namespace {

constexpr std::array<double, 3> places_in_cell{-0.25, 0.0, 0.25};

/// In the tag's frame: a place in a cell, counted in cells from the cell's middle.
Eigen::Vector2d on_tag(const TagPattern& pattern, int row, int column, double dx, double dy) {
    const int side = pattern.outline_cells();
    return {(column + 0.5 + dx - pattern.rim) * 2 / side - 1, (row + 0.5 + dy - pattern.rim) * 2 / side - 1};
}

/// P(R^2 > level) of one regressor among `cells` levels of chance that has only the right sign: half of
/// I_(1 - level)((cells - 4)/2, 1/2), by the angle whose sine is R.
class ChanceOfMore {
  public:
    explicit ChanceOfMore(int cells) : power_(cells - 5), whole_(tail_from(0.0)) {}
    double operator()(double level) const { return 0.5 * tail_from(std::asin(std::sqrt(level))) / whole_; }

  private:
    double tail_from(double angle) const {
        constexpr int steps = 2000;
        const double step = (0.5 * std::numbers::pi - angle) / steps;
        double sum = 0.0;
        for (int k = 0; k < steps; ++k) sum += std::pow(std::cos(angle + (k + 0.5) * step), power_);
        return sum * step;
    }

    int power_;
    double whole_;
};

/// Sums over the points of the cells, and over each cell alone.
struct CellSums {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();  ///< of the terms 1, pattern, x, y
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sum_of_squares = 0.0;
    std::array<double, TagPattern::most_cells * TagPattern::most_cells> grey{};
    std::array<int, TagPattern::most_cells * TagPattern::most_cells> count{};
};

/// @param code_alone  leaves out the cells that are alike on every tag
CellSums sums_of_cells(const cv::Mat& image, const Eigen::Matrix3d& homography, const TagPattern& pattern,
                       bool code_alone) {
    CellSums sums;
    const int cells = pattern.cells;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int cell = row * cells + column;
            if (code_alone && !pattern.code[static_cast<std::size_t>(cell)]) continue;
            for (const double dy : places_in_cell)
                for (const double dx : places_in_cell) {
                    const Eigen::Vector2d at = on_tag(pattern, row, column, dx, dy);
                    const Eigen::Vector2d at_px = map_point(homography, at);
                    if (!can_sample(image, at_px)) continue;
                    const double grey = sample(image, at_px);
                    const Eigen::Vector4d terms(1.0, pattern[cell] ? 1.0 : 0.0, at.x(), at.y());
                    sums.normal += terms * terms.transpose();
                    sums.right += terms * grey;
                    sums.sum_of_squares += grey * grey;
                    sums.grey[cell] += grey;
                    ++sums.count[cell];
                }
        }
    return sums;
}

/// @param fit  black, white - black, gx, gy
void count_bits(const CellSums& sums, const Eigen::Vector4d& fit, const TagPattern& pattern,
                PatternMatch& match) {
    const int cells = pattern.cells;
    match.wrong_code_bits = match.wrong_fixed_cells = 0;
    const auto bits = static_cast<double>(pattern.code.count());
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int cell = row * cells + column;
            const Eigen::Vector2d at = on_tag(pattern, row, column, 0.0, 0.0);
            const double middle = fit(0) + 0.5 * fit(1) + fit.tail<2>().dot(at);
            const double above = sums.count[cell] > 0 ? sums.grey[cell] / sums.count[cell] - middle : 0.0;
            const double agrees = pattern[cell] ? above : -above;
            if (pattern.code[static_cast<std::size_t>(cell)]) {
                match.wrong_code_bits += agrees > 0 ? 0 : 1;
                match.margin += std::abs(above) / bits;
            } else {
                match.wrong_fixed_cells += agrees > 0 ? 0 : 1;
            }
        }
}

struct PatternFit {
    CellSums sums;
    Eigen::Vector4d light;  ///< black, white - black, gx, gy
    double explained;
};

/// Empty if more than a quarter of the cells lie outside the image, or if black is brighter than white.
std::optional<PatternFit> fit_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                                      const TagPattern& pattern, std::size_t cells, bool code_alone) {
    const std::array<int, 3> light_terms{0, 2, 3};
    const Eigen::Matrix3d homography = square_to_image(corners_px);
    if (!homography.allFinite()) return std::nullopt;
    const CellSums sums = sums_of_cells(image, homography, pattern, code_alone);
    const auto points = static_cast<double>(cells * places_in_cell.size() * places_in_cell.size());
    if (sums.normal(0, 0) < 0.75 * points) return std::nullopt;
    const Eigen::Vector4d fit = solve_normal(sums.normal, sums.right);
    const Eigen::Matrix3d light_normal = sums.normal(light_terms, light_terms);
    const Eigen::Vector3d light_right = sums.right(light_terms);
    const double left_by_light =
        sums.sum_of_squares - solve_normal(light_normal, light_right).dot(light_right);
    if (!(left_by_light > 0) || !(fit(1) > 0)) return std::nullopt;
    return PatternFit{sums, fit, 1.0 - (sums.sum_of_squares - fit.dot(sums.right)) / left_by_light};
}

/// The level at which chance agrees with a family as often as with the usual one.
double level_for(const TagFamily& family, int cells, int usual_cells) {
    constexpr double usual_level = 0.4;
    constexpr int halvings = 20;
    const double wanted = usual_tag_family().size() * ChanceOfMore(usual_cells)(usual_level);
    const ChanceOfMore chance(cells);
    double low = 0.0, high = 1.0;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (family.size() * chance(middle) > wanted ? low : high) = middle;
    }
    return high;
}

}  // namespace

PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern) {
    PatternMatch match;
    const auto cells = cell_at(pattern.cells, 0, pattern.cells);
    const std::optional<PatternFit> fit = fit_pattern(image, corners_px, pattern, cells, false);
    if (!fit) return match;
    match.explained = fit->explained;
    match.contrast = fit->light(1);
    count_bits(fit->sums, fit->light, pattern, match);
    return match;
}

double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern) {
    return match_pattern(image, corners_px, pattern).explained;
}

double explained_code(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                      const TagPattern& pattern) {
    const std::optional<PatternFit> fit = fit_pattern(image, corners_px, pattern, pattern.code.count(), true);
    return fit ? fit->explained : 0.0;
}

namespace {

LeastExplained least_by_chance(const TagFamily& family) {
    const TagFamily& usual = usual_tag_family();
    const auto bits = [](const TagFamily& of) {
        return static_cast<int>(std::ranges::count(of.layout, 'd'));
    };
    return {level_for(family, family.cells * family.cells, usual.cells * usual.cells),
            level_for(family, bits(family), bits(usual))};
}

}  // namespace

LeastExplained least_explained(const TagFamily& family) {
    if (&family == &usual_tag_family()) return {0.4, 0.0};
    static std::mutex mutex;
    static std::map<const TagFamily*, LeastExplained> known;  // a level takes milliseconds to compute
    const std::scoped_lock lock(mutex);
    const auto place = known.find(&family);
    return (place != known.end() ? place : known.emplace(&family, least_by_chance(family)).first)->second;
}

bool is_convincing(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                   const TagPattern& pattern, const LeastExplained& least) {
    return explained_contrast(image, corners_px, pattern) >= least.of_tag &&
           (least.of_code == 0.0 || explained_code(image, corners_px, pattern) >= least.of_code);
}

}  // namespace fidservo::vision
