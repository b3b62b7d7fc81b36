#include "vision/tag_pattern.h"

#include "core/failure.h"
#include "vision/quad.h"

#include <memory>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include <Eigen/Cholesky>

namespace fidservo::vision {

TagPattern tag_pattern(int tag_id) {
    const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> book(tag36h11_create(),
                                                                               tag36h11_destroy);
    FIDSERVO_DEMAND(tag_id >= 0 && tag_id < static_cast<int>(book->ncodes));
    TagPattern pattern;
    for (std::uint32_t bit = 0; bit < book->nbits; ++bit)
        pattern[8 * book->bit_y[bit] + book->bit_x[bit]] =
            ((book->codes[tag_id] >> (book->nbits - 1 - bit)) & 1U) != 0;
    return pattern;
}

double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern) {
    constexpr int cells = 8;
    constexpr std::array<double, 3> places_in_cell{-0.25, 0.0, 0.25};
    const std::array<int, 3> light_terms{0, 2, 3};
    const Eigen::Matrix3d homography = square_to_image(corners_px);
    if (!homography.allFinite()) return 0.0;

    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sum_of_squares = 0.0;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column)
            for (const double dy : places_in_cell)
                for (const double dx : places_in_cell) {
                    const Eigen::Vector2d at((column + 0.5 + dx) * 2 / cells - 1,
                                             (row + 0.5 + dy) * 2 / cells - 1);
                    const Eigen::Vector2d at_px = map_point(homography, at);
                    if (!can_sample(image, at_px)) continue;
                    const double grey = sample(image, at_px);
                    const Eigen::Vector4d terms(1.0, pattern[row * cells + column] ? 1.0 : 0.0, at.x(),
                                                at.y());
                    normal += terms * terms.transpose();
                    right += terms * grey;
                    sum_of_squares += grey * grey;
                }
    constexpr double points = cells * cells * places_in_cell.size() * places_in_cell.size();
    if (normal(0, 0) < 0.75 * points) return 0.0;
    const Eigen::Vector4d fit = normal.ldlt().solve(right);
    const Eigen::Matrix3d light_normal = normal(light_terms, light_terms);
    const Eigen::Vector3d light_right = right(light_terms);
    const double left_by_light = sum_of_squares - light_normal.ldlt().solve(light_right).dot(light_right);
    if (!(left_by_light > 0) || !(fit(1) > 0)) return 0.0;
    return 1.0 - (sum_of_squares - fit.dot(right)) / left_by_light;
}

}  // namespace fidservo::vision
