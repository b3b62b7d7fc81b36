#include "vision/tag_pattern.h"

#include "core/demand.h"
#include "core/normal_equations.h"
#include "vision/quad.h"

#include <algorithm>
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

constexpr int code_cells = 6;
constexpr int most_cells = code_cells + 2 * 2;
constexpr std::array<double, 3> places_in_cell{-0.25, 0.0, 0.25};

std::vector<TagPattern> read_book(int border_cells) {
    constexpr int border_of_book = 1;
    const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> book(tag36h11_create(),
                                                                               tag36h11_destroy);
    std::vector<TagPattern> patterns(book->ncodes);
    for (std::uint32_t id = 0; id < book->ncodes; ++id) {
        patterns[id].cells = code_cells + 2 * border_cells;
        for (std::uint32_t bit = 0; bit < book->nbits; ++bit) {
            const std::uint32_t row = book->bit_y[bit] - border_of_book + border_cells;
            const std::uint32_t column = book->bit_x[bit] - border_of_book + border_cells;
            patterns[id].white[patterns[id].cells * row + column] =
                ((book->codes[id] >> (book->nbits - 1 - bit)) & 1U) != 0;
        }
    }
    return patterns;
}

bool is_border(const TagPattern& pattern, int row, int column) {
    const int border = (pattern.cells - code_cells) / 2;
    return std::min(row, column) < border || std::max(row, column) >= pattern.cells - border;
}

/// Sums over the points of the cells, and over each cell alone.
struct CellSums {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();  ///< of the terms 1, pattern, x, y
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sum_of_squares = 0.0;
    std::array<double, most_cells * most_cells> grey{};
    std::array<int, most_cells * most_cells> count{};
};

CellSums sums_of_cells(const cv::Mat& image, const Eigen::Matrix3d& homography, const TagPattern& pattern) {
    CellSums sums;
    const int cells = pattern.cells;
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
    const int cells = pattern.cells;
    match.wrong_code_bits = match.wrong_border_cells = 0;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const int cell = row * cells + column;
            const Eigen::Vector2d at((column + 0.5) * 2 / cells - 1, (row + 0.5) * 2 / cells - 1);
            const double middle = fit(0) + 0.5 * fit(1) + fit.tail<2>().dot(at);
            const double above = sums.count[cell] > 0 ? sums.grey[cell] / sums.count[cell] - middle : 0.0;
            const double agrees = pattern[cell] ? above : -above;
            if (is_border(pattern, row, column)) {
                match.wrong_border_cells += agrees > 0 ? 0 : 1;
            } else {
                match.wrong_code_bits += agrees > 0 ? 0 : 1;
                match.margin += std::abs(above) / (code_cells * code_cells);
            }
        }
}

}  // namespace

TagPattern tag_pattern(int tag_id, int border_cells) {
    static const std::array<std::vector<TagPattern>, 2> books{read_book(1), read_book(2)};
    FIDSERVO_DEMAND(border_cells == 1 || border_cells == 2);
    const std::vector<TagPattern>& book = books[static_cast<std::size_t>(border_cells - 1)];
    FIDSERVO_DEMAND(tag_id >= 0 && tag_id < static_cast<int>(book.size()));
    return book[static_cast<std::size_t>(tag_id)];
}

PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern) {
    const std::array<int, 3> light_terms{0, 2, 3};
    const Eigen::Matrix3d homography = square_to_image(corners_px);
    if (!homography.allFinite()) return {};
    const CellSums sums = sums_of_cells(image, homography, pattern);
    const auto points =
        static_cast<double>(pattern.cells * pattern.cells * places_in_cell.size() * places_in_cell.size());
    if (sums.normal(0, 0) < 0.75 * points) return {};
    const Eigen::Vector4d fit = solve_normal(sums.normal, sums.right);
    const Eigen::Matrix3d light_normal = sums.normal(light_terms, light_terms);
    const Eigen::Vector3d light_right = sums.right(light_terms);
    const double left_by_light =
        sums.sum_of_squares - solve_normal(light_normal, light_right).dot(light_right);
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
