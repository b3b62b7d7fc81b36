// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The least-squares problem behind camera_calibration.h.
#include "calib/camera/lens_projection.h"
#include "calib/camera/plane_pose.h"
#include "calib/camera/target_view.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// A pose as a solver's block: rotation vector, rad, and shift in mm.
using PoseBlock = std::array<double, 6>;
using LensFlags = std::array<bool, lens_parameters>;

PoseBlock block_of(const PlanePose& pose);
PlanePose pose_of(const PoseBlock& block);

/// The adjusted quantities: a lens, and a pose for each view.
struct BundleState {
    Lens lens;
    std::vector<PoseBlock> poses;
};

struct BundleCovariance {
    Eigen::Matrix<double, lens_parameters, lens_parameters> lens;
    std::vector<Eigen::Matrix<double, 6, 6>> poses;
};

/// Tags in views with their weights; a tag can be excluded.
class Bundle {
  public:
    Bundle(LensModel model, const std::vector<TargetView>& views, double extra_std_px);

    /// Adjusts the poses and the flagged parameters of the lens. Returns chi^2, or nothing without a
    /// solution.
    std::optional<double> adjust(BundleState& state, const LensFlags& fitted) const;

    /// A rough adjustment that is robust against single tags that are far off (Huber's loss). Returns twice
    /// the loss.
    double approach(BundleState& state, const LensFlags& fitted) const;

    /// Adjusts one view's pose alone. Returns its chi^2.
    double adjust_pose(const Lens& lens, std::size_t view, PoseBlock& pose) const;

    /// The covariance of all adjusted quantities; empty if the Jacobian is rank deficient.
    std::optional<BundleCovariance> covariance(BundleState state, const LensFlags& fitted) const;

    /// Excludes tags that fit badly and includes excluded tags again that now fit well. Returns whether that
    /// changed anything.
    bool sort_out(const BundleState& state);

    /// Measured minus modelled corners of a tag, px.
    Eigen::Matrix<double, 8, 1> error_px(const BundleState& state, std::size_t view, std::size_t tag) const;

    bool uses(std::size_t view, std::size_t tag) const { return sights_[view][tag].used; }
    int measured_directions() const;

  private:
    struct Sight {
        std::array<Eigen::Vector2d, 4> printed_mm;
        Eigen::Matrix<double, 8, 1> seen_px;
        CornerWeights weights;
        bool used = true;
    };
    struct Residual;
    struct Problem;
    void build(Problem& problem, BundleState& state, const LensFlags& fitted, bool robust) const;
    double mean_square(const BundleState& state, std::size_t view, std::size_t tag) const;

    LensModel model_;
    std::vector<std::vector<Sight>> sights_;
};

}  // namespace fidservo::calib
