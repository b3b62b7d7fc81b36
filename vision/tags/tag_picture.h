// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The mapping between the plane of a tag and the image, with parameters to be fitted.
//
// Tag frame: x to the right, y down on an upright tag, origin at the tag's centre, unit one cell of the code.
#include "core/camera/camera_geometry.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fidservo::vision {

/// The map from pixels to cells has two steps, which are cheap in inner loops: q = cubic(u, v), then the
/// projective map (x, y, 1) ~ m (q_x, q_y, 1), whose parameters are fitted. With a calibrated camera, q is a
/// point in the plate's plane by the camera's calibration (mirrored if the tag's picture is) and m a
/// similarity; without a camera, q is an image point and m any homography.
class TagPicture {
  public:
    static constexpr int cubic_terms = 10;
    static constexpr int most_parameters = 8;
    using Generators = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, most_parameters>;

    /// A cubic polynomial in U and V, (U, V) = ((u, v) - origin) / unit: coefficients of 1, U, V, U^2, UV,
    /// V^2, U^3, U^2 V, U V^2, V^3.
    struct Cubic {
        Eigen::Vector2d origin_px;
        double unit_px;
        std::array<Eigen::Vector2d, cubic_terms> coefficients;
    };

    /// @param corners_px  of the outline, in the order of detections
    /// @param cells  along a side of the outline
    /// @param rim  cells of the print beyond the outline
    TagPicture(const std::array<Eigen::Vector2d, 4>& corners_px, int cells,
               const std::optional<CameraGeometry>& camera, int rim = 0);

    /// The number of parameters. 4: shift in x and y, scale, rotation. 8: also aspect, shear and two of
    /// perspective.
    int parameters() const { return camera_ ? 4 : most_parameters; }

    /// d (x, y) / d parameters at a point: how change() moves the point that is mapped there.
    Generators generators(const Eigen::Vector2d& cell) const;

    /// Changes the parameters such that what was mapped to (x, y) is mapped to (x, y) + generators(x, y)
    /// step, to first order.
    void change(const Eigen::VectorXd& step);

    Eigen::Vector2d image_of(const Eigen::Vector2d& cell) const;
    /// d (x, y) / d (u, v) at an image point.
    Eigen::Matrix2d cells_by_px(const Eigen::Vector2d& image_px) const;
    /// d (u, v) / d parameters of the image of a point.
    Generators image_by_parameters(const Eigen::Vector2d& cell) const;

    const Cubic& cubic() const { return cubic_; }
    const Eigen::Matrix3d& m() const { return m_; }

  private:
    void follow_camera(const std::array<Eigen::Vector2d, 4>& corners_px, int cells, int rim);
    void follow_image(const std::array<Eigen::Vector2d, 4>& corners_px, int cells);

    std::optional<CameraGeometry> camera_;
    Eigen::Vector2d centre_mm_ = Eigen::Vector2d::Zero();  ///< the plate point of q = 0
    Eigen::Matrix2d mm_by_q_ = Eigen::Matrix2d::Identity();
    Cubic cubic_;
    Eigen::Matrix3d m_ = Eigen::Matrix3d::Identity();
};

}  // namespace fidservo::vision
