// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The projection of core/camera/camera_geometry.h as a template, for solvers that differentiate it
// automatically.
#include "core/camera/camera_geometry.h"
#include "core/camera/lens_picture.h"

#include <array>
#include <string_view>

#include <Eigen/Core>

namespace fidservo::calib {

/// Indices of the lens's parameters in a solver's block: f, q, u0, v0, then the coefficients of both models.
/// The last one is no parameter of the lens but the size of the target's tags, with their centres kept,
/// relative to the stated size; it serves to check a target's description.
enum LensParameter {
    focal,           ///< f, px
    focal_ratio,     ///< q
    centre_u,        ///< u0, px
    centre_v,        ///< v0, px
    k1,              ///< radial
    k2,              ///< radial
    p1,              ///< tangential, of plumb_bob only
    p2,              ///< tangential, of plumb_bob only
    k3,              ///< radial
    k4,              ///< of equidistant only
    tag_scale,       ///< of the target, not of the lens
    lens_parameters  ///< number of parameters
};

/// The name of a parameter in rig files' provenance and in reports.
inline std::string_view name_of(LensParameter parameter) {
    constexpr std::array<std::string_view, lens_parameters> names{"focal_px",
                                                                  "focal_ratio",
                                                                  "principal_point_u_px",
                                                                  "principal_point_v_px",
                                                                  "k1",
                                                                  "k2",
                                                                  "p1",
                                                                  "p2",
                                                                  "k3",
                                                                  "k4",
                                                                  "tag_scale"};
    return names[parameter];
}

/// Whether a lens of that model has the parameter.
inline bool belongs_to(LensModel model, LensParameter parameter) {
    if (parameter == tag_scale) return false;
    const bool is_equidistant = model == LensModel::equidistant;
    if (parameter == p1 || parameter == p2) return !is_equidistant;
    return parameter != k4 || is_equidistant;
}

/// A lens as a solver sees it: its numbers, in the order of LensParameter.
using Lens = std::array<double, lens_parameters>;

/// The numbers of a camera's lens.
inline Lens lens_of(const CameraGeometry& camera) {
    const LensDistortion& d = camera.distortion;
    return {camera.focal_px,
            camera.focal_ratio,
            camera.principal_point_px.x(),
            camera.principal_point_px.y(),
            d.k1,
            d.k2,
            d.p1,
            d.p2,
            d.k3,
            d.k4,
            1.0};
}

/// Sets the lens's numbers; the lens model of the camera stays.
inline void set_lens(CameraGeometry& camera, const Lens& lens) {
    camera.focal_px = lens[focal];
    camera.focal_ratio = lens[focal_ratio];
    camera.principal_point_px = {lens[centre_u], lens[centre_v]};
    camera.distortion = {lens[k1], lens[k2], lens[p1], lens[p2], lens[k3], lens[k4], camera.distortion.model};
}

/// Image point in px of a point in the camera's frame; the equations of core/camera/camera_geometry.h, for an
/// equidistant lens also beyond its domain. That model has no p1 and p2; here they act on its picture, so
/// that the uncertainty which their absence causes in the other parameters can be computed.
template <class T>
Eigen::Matrix<T, 2, 1> image_of(LensModel model, const T* lens, const Eigen::Matrix<T, 3, 1>& seen) {
    Eigen::Matrix<T, 2, 1> bent;
    if (model == LensModel::plumb_bob) {
        const Eigen::Matrix<T, 2, 1> ideal(seen.x() / seen.z(), seen.y() / seen.z());
        bent = distorted(lens + k1, ideal);
    } else {
        const Eigen::Matrix<T, 2, 1> centred = fisheye_picture(lens[k1], lens[k2], lens[k3], lens[k4], seen);
        bent = decentred(centred, lens[p1], lens[p2], centred);
    }
    return {lens[centre_u] + lens[focal] * bent.x(),
            lens[centre_v] + lens[focal] * lens[focal_ratio] * bent.y()};
}

}  // namespace fidservo::calib
