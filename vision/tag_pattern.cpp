#include "vision/tag_pattern.h"

#include "core/failure.h"
#include "vision/quad.h"

#include <cmath>
#include <memory>
#include <vector>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include <Eigen/Cholesky>

namespace fidservo::vision {

namespace {

constexpr int cells = 8;
constexpr std::array<double, 3> places_in_cell{-0.25, 0.0, 0.25};
constexpr double points = cells * cells * places_in_cell.size() * places_in_cell.size();

std::vector<TagPattern> read_book() {
    const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> book(tag36h11_create(),
                                                                               tag36h11_destroy);
    std::vector<TagPattern> patterns(book->ncodes);
    for (std::uint32_t id = 0; id < book->ncodes; ++id)
        for (std::uint32_t bit = 0; bit < book->nbits; ++bit)
            patterns[id][8 * book->bit_y[bit] + book->bit_x[bit]] =
                ((book->codes[id] >> (book->nbits - 1 - bit)) & 1U) != 0;
    return patterns;
}

bool is_border(int row, int column) {
    return row == 0 || column == 0 || row == cells - 1 || column == cells - 1;
}

/// Sums over the points of the cells, and over each cell alone.
struct CellSums {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();  ///< of the terms 1, pattern, x, y
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sum_of_squares = 0.0;
    std::array<double, cells * cells> grey{};
    std::array<int, cells * cells> count{};
};

CellSums add_up(const cv::Mat& image, const Eigen::Matrix3d& homography, const TagPattern& pattern) {
    CellSums sums;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int cell = row * cells + column;
            for (const double dy : places_in_cell)
                for (const double dx : places_in_cell) {
                    const Eigen::Vector2d at((column + 0.5 + dx) * 2 / cells - 1,
                                             (row + 0.5 + dy) * 2 / cells - 1);
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
    match.wrong_code_bits = match.wrong_border_cells = 0;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int cell = row * cells + column;
            const Eigen::Vector2d at((column + 0.5) * 2 / cells - 1, (row + 0.5) * 2 / cells - 1);
            const double middle = fit(0) + 0.5 * fit(1) + fit.tail<2>().dot(at);
            const double above = sums.count[cell] > 0 ? sums.grey[cell] / sums.count[cell] - middle : 0.0;
            const double agrees = pattern[cell] ? above : -above;
            if (is_border(row, column)) {
                match.wrong_border_cells += agrees > 0 ? 0 : 1;
            } else {
                match.wrong_code_bits += agrees > 0 ? 0 : 1;
                match.margin += std::abs(above) / ((cells - 2) * (cells - 2));
            }
        }
}

}  // namespace

TagPattern tag_pattern(int tag_id) {
    static const std::vector<TagPattern> book = read_book();
    FIDSERVO_DEMAND(tag_id >= 0 && tag_id < static_cast<int>(book.size()));
    return book[static_cast<std::size_t>(tag_id)];
}

PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern) {
    const std::array<int, 3> light_terms{0, 2, 3};
    const Eigen::Matrix3d homography = square_to_image(corners_px);
    if (!homography.allFinite()) return {};
    const CellSums sums = add_up(image, homography, pattern);
    if (sums.normal(0, 0) < 0.75 * points) return {};
    const Eigen::Vector4d fit = sums.normal.ldlt().solve(sums.right);
    const Eigen::Matrix3d light_normal = sums.normal(light_terms, light_terms);
    const Eigen::Vector3d light_right = sums.right(light_terms);
    const double left_by_light =
        sums.sum_of_squares - light_normal.ldlt().solve(light_right).dot(light_right);
    if (!(left_by_light > 0) || !(fit(1) > 0)) return {};
    PatternMatch match;
    match.explained = 1.0 - (sums.sum_of_squares - fit.dot(sums.right)) / left_by_light;
    match.contrast = fit(1);
    count_bits(sums, fit, pattern, match);
    return match;
}

double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern) {
    return match_pattern(image, corners_px, pattern).explained;
}

}  // namespace fidservo::vision
