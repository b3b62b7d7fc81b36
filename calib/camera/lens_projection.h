#pragma once
// The projection of core/camera_geometry.h for solvers that differentiate it.
#include "core/camera_geometry.h"
#include "core/plumb_bob.h"

#include <algorithm>
#include <array>
#include <span>

#include <Eigen/Core>

namespace fidservo::calib {

/// The lens's parameters as a solver's block: f, q, u0, v0, then the distortion in OpenCV's order.
enum LensParameter { focal, focal_ratio, centre_u, centre_v, k1, k2, p1, p2, k3, lens_parameters };

using Lens = std::array<double, lens_parameters>;

inline Lens lens_of(const CameraGeometry& camera) {
    Lens lens{camera.focal_px, camera.focal_ratio, camera.principal_point_px.x(),
              camera.principal_point_px.y()};
    std::ranges::copy(numbers_of(camera.distortion), lens.begin() + k1);
    return lens;
}

inline void set_lens(CameraGeometry& camera, const Lens& lens) {
    camera.focal_px = lens[focal];
    camera.focal_ratio = lens[focal_ratio];
    camera.principal_point_px = {lens[centre_u], lens[centre_v]};
    camera.distortion = distortion_of(std::span(lens).subspan<k1, 5>());
}

/// Image point in px of a point in the camera's frame; the equations of core/camera_geometry.h.
template <class T>
Eigen::Matrix<T, 2, 1> image_of(const T* lens, const Eigen::Matrix<T, 3, 1>& seen) {
    const Eigen::Matrix<T, 2, 1> ideal(seen.x() / seen.z(), seen.y() / seen.z());
    const Eigen::Matrix<T, 2, 1> bent = distorted(lens + k1, ideal);
    return {lens[centre_u] + lens[focal] * bent.x(),
            lens[centre_v] + lens[focal] * lens[focal_ratio] * bent.y()};
}

}  // namespace fidservo::calib
