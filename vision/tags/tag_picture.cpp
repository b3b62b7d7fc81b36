// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_picture.h"

#include "vision/tags/quad.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace fidservo::vision {
namespace {

using Terms = Eigen::Matrix<double, TagPicture::cubic_terms, 1>;

Terms terms_at(const Eigen::Vector2d& at) {
    const double u = at.x(), v = at.y();
    Terms terms;
    terms << 1.0, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    return terms;
}

Eigen::Matrix<double, TagPicture::cubic_terms, 2> term_slopes_at(const Eigen::Vector2d& at) {
    const double u = at.x(), v = at.y();
    Eigen::Matrix<double, TagPicture::cubic_terms, 2> slopes;
    slopes << 0, 0, 1, 0, 0, 1, 2 * u, 0, v, u, 0, 2 * v, 3 * u * u, 0, 2 * u * v, u * u, v * v, 2 * u * v, 0,
        3 * v * v;
    return slopes;
}

Eigen::Vector2d mean_of(const std::array<Eigen::Vector2d, 4>& points) {
    return 0.25 * (points[0] + points[1] + points[2] + points[3]);
}

double reach_of(const std::array<Eigen::Vector2d, 4>& corners_px, const Eigen::Vector2d& centre_px) {
    double reach = 0.0;
    for (const Eigen::Vector2d& corner : corners_px) reach = std::max(reach, (corner - centre_px).norm());
    return reach;
}

}  // namespace

TagPicture::TagPicture(const std::array<Eigen::Vector2d, 4>& corners_px, int cells,
                       const std::optional<CameraGeometry>& camera, int rim)
    : camera_(camera) {
    cubic_.origin_px = mean_of(corners_px);
    cubic_.unit_px = reach_of(corners_px, cubic_.origin_px);
    if (camera_)
        follow_camera(corners_px, cells, rim);
    else
        follow_image(corners_px, cells);
}

/// q: cells of a tag on the plate that fits the corners best up to a similarity; the cubic is fitted to where
/// the camera shows a lattice of them.
void TagPicture::follow_camera(const std::array<Eigen::Vector2d, 4>& corners_px, int cells, int rim) {
    const double x_sign = is_mirrored(corners_px) ? -1.0 : 1.0;
    std::array<Eigen::Vector2d, 4> on_plate_mm;
    for (std::size_t k = 0; k < 4; ++k) on_plate_mm[k] = back_project(*camera_, corners_px[k], 0.0);
    centre_mm_ = mean_of(on_plate_mm);
    double cosine = 0.0, sine = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d to = on_plate_mm[k] - centre_mm_;
        const Eigen::Vector2d corner(x_sign * tag_corners[k].x(), tag_corners[k].y());
        cosine += corner.dot(to);
        sine += corner.x() * to.y() - corner.y() * to.x();
    }
    const double mm_per_cell = 1.0 / (4.0 * cells);  // sum of squares of the corners 8, half a side cells / 2
    mm_by_q_ << x_sign * cosine, -sine, x_sign * sine, cosine;
    mm_by_q_ *= mm_per_cell;

    constexpr int nodes = 5;
    const double reach = 0.5 * cells + rim + 1.0;
    Eigen::Matrix<double, cubic_terms, cubic_terms> normal =
        Eigen::Matrix<double, cubic_terms, cubic_terms>::Zero();
    Eigen::Matrix<double, cubic_terms, 2> right = Eigen::Matrix<double, cubic_terms, 2>::Zero();
    for (int row = 0; row < nodes; ++row)
        for (int column = 0; column < nodes; ++column) {
            const Eigen::Vector2d q =
                reach * Eigen::Vector2d(2.0 * column / (nodes - 1) - 1.0, 2.0 * row / (nodes - 1) - 1.0);
            const Terms terms = terms_at((image_of(q) - cubic_.origin_px) / cubic_.unit_px);
            normal += terms * terms.transpose();
            right += terms * q.transpose();
        }
    const Eigen::Matrix<double, cubic_terms, 2> fit = normal.ldlt().solve(right);
    for (int k = 0; k < cubic_terms; ++k) cubic_.coefficients[k] = fit.row(k).transpose();
}

void TagPicture::follow_image(const std::array<Eigen::Vector2d, 4>& corners_px, int cells) {
    cubic_.coefficients.fill(Eigen::Vector2d::Zero());
    cubic_.coefficients[1] = {1.0, 0.0};
    cubic_.coefficients[2] = {0.0, 1.0};
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = (corners_px[k] - cubic_.origin_px) / cubic_.unit_px;
    const Eigen::Matrix3d to_square = square_to_image(corners).inverse();
    m_ = Eigen::Vector3d(0.5 * cells, 0.5 * cells, 1.0).asDiagonal() * to_square;
    m_ /= m_(2, 2);
}

TagPicture::Generators TagPicture::generators(const Eigen::Vector2d& cell) const {
    const double x = cell.x(), y = cell.y();
    Generators all(2, parameters());
    all.leftCols<4>() << 1, 0, x, -y, 0, 1, y, x;
    if (!camera_) all.rightCols<4>() << x, y, x * x, x * y, -y, x, x * y, y * y;
    return all;
}

void TagPicture::change(const Eigen::VectorXd& step) {
    Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
    by(0, 0) += step(2);
    by(0, 1) -= step(3);
    by(0, 2) += step(0);
    by(1, 0) += step(3);
    by(1, 1) += step(2);
    by(1, 2) += step(1);
    if (!camera_) {
        by(0, 0) += step(4);
        by(1, 1) -= step(4);
        by(0, 1) += step(5);
        by(1, 0) += step(5);
        by(2, 0) -= step(6);
        by(2, 1) -= step(7);
    }
    m_ = by * m_;
    m_ /= m_(2, 2);
}

Eigen::Vector2d TagPicture::image_of(const Eigen::Vector2d& cell) const {
    const Eigen::Vector3d mapped = m_.inverse() * cell.homogeneous();
    const Eigen::Vector2d q = mapped.head<2>() / mapped.z();
    if (!camera_) return cubic_.origin_px + cubic_.unit_px * q;
    return project(*camera_, centre_mm_ + mm_by_q_ * q, 0.0);
}

Eigen::Matrix2d TagPicture::cells_by_px(const Eigen::Vector2d& image_px) const {
    const Eigen::Vector2d at = (image_px - cubic_.origin_px) / cubic_.unit_px;
    const Terms terms = terms_at(at);
    const Eigen::Matrix<double, cubic_terms, 2> slopes = term_slopes_at(at);
    Eigen::Vector2d q = Eigen::Vector2d::Zero();
    Eigen::Matrix2d q_by_at = Eigen::Matrix2d::Zero();
    for (int k = 0; k < cubic_terms; ++k) {
        q += terms(k) * cubic_.coefficients[k];
        q_by_at += cubic_.coefficients[k] * slopes.row(k);
    }
    const Eigen::Vector3d mapped = m_ * q.homogeneous();
    const Eigen::Vector2d cell = mapped.head<2>() / mapped.z();
    const Eigen::Matrix2d cell_by_q =
        (m_.topLeftCorner<2, 2>() - cell * m_.bottomLeftCorner<1, 2>()) / mapped.z();
    return cell_by_q * q_by_at / cubic_.unit_px;
}

TagPicture::Generators TagPicture::image_by_parameters(const Eigen::Vector2d& cell) const {
    return -cells_by_px(image_of(cell)).inverse() * generators(cell);
}

}  // namespace fidservo::vision
