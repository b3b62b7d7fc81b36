#pragma once
// The projection of core/camera_geometry.h for solvers that differentiate it.
#include "core/camera_geometry.h"

#include <array>

#include <Eigen/Core>

namespace fidservo::calib {

/// The lens's parameters as a solver's block: f, q, u0, v0, then the distortion in OpenCV's order.
enum LensParameter { focal, focal_ratio, centre_u, centre_v, k1, k2, p1, p2, k3, lens_parameters };

using Lens = std::array<double, lens_parameters>;

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
            d.k3};
}

inline void set_lens(CameraGeometry& camera, const Lens& lens) {
    camera.focal_px = lens[focal];
    camera.focal_ratio = lens[focal_ratio];
    camera.principal_point_px = {lens[centre_u], lens[centre_v]};
    camera.distortion = {lens[k1], lens[k2], lens[p1], lens[p2], lens[k3]};
}

/// Image point in px of a point in the camera's frame; the equations of core/camera_geometry.h.
template <class T>
Eigen::Matrix<T, 2, 1> image_of(const T* lens, const Eigen::Matrix<T, 3, 1>& seen) {
    const T x = seen.x() / seen.z(), y = seen.y() / seen.z();
    const T r2 = x * x + y * y;
    const T radial = 1.0 + r2 * (lens[k1] + r2 * (lens[k2] + r2 * lens[k3]));
    const T bent_x = x * radial + 2.0 * lens[p1] * x * y + lens[p2] * (r2 + 2.0 * x * x);
    const T bent_y = y * radial + lens[p1] * (r2 + 2.0 * y * y) + 2.0 * lens[p2] * x * y;
    return {lens[centre_u] + lens[focal] * bent_x, lens[centre_v] + lens[focal] * lens[focal_ratio] * bent_y};
}

}  // namespace fidservo::calib
