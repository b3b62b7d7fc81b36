// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/placement.h"

#include "core/camera/camera_covariance.h"
#include "core/failure.h"
#include "core/units.h"
#include "src/inspect/recipe/recipe.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

/// Mean of what several images say about one neighbour.
struct Difference {
    Eigen::Array2d sum_um{0.0, 0.0};
    Eigen::Array2d variance_sum_um2{0.0, 0.0};
    VectorByCamera by_camera_sum = VectorByCamera::Zero();
    int count = 0;

    Eigen::Array2d mean_um() const { return sum_um / count; }
    Eigen::Array2d variance_um2() const { return variance_sum_um2 / (count * count); }
    VectorByCamera by_camera() const { return by_camera_sum / count; }
};

void add_image(const Snapshot& snapshot, const Plate& nominal, int tag_id,
               std::map<int, Difference>& differences) {
    const auto own =
        std::ranges::find_if(snapshot.tags, [&](const auto& tag) { return tag.detection.tag_id == tag_id; });
    if (own == snapshot.tags.end()) return;
    const auto variance_um2 = [&](const vision::RefinedTag& tag) {
        const vision::LocalPicture picture = picture_around(snapshot.image, tag.centre_px);
        return plate_std_um(picture, tag.centre_covariance_px2).array().square().eval();
    };
    for (const vision::RefinedTag& other : snapshot.tags) {
        if (other.detection.tag_id == tag_id) continue;
        const Eigen::Vector2d nominal_mm =
            find_tag(nominal, tag_id)->centre_mm - find_tag(nominal, other.detection.tag_id)->centre_mm;
        const Eigen::Vector2d seen_mm =
            to_plate(snapshot.image, own->centre_px) - to_plate(snapshot.image, other.centre_px);
        Difference& difference = differences[other.detection.tag_id];
        difference.sum_um += ((seen_mm - nominal_mm) * um_per_mm).array();
        difference.variance_sum_um2 += variance_um2(*own) + variance_um2(other);
        difference.by_camera_sum += vector_by_camera(snapshot.image.camera.geometry, other.centre_px,
                                                     own->centre_px, snapshot.image.axis_mm.x());
        ++difference.count;
    }
}

}  // namespace

Result<Placement> measure_placement(const std::vector<Snapshot>& snapshots, const Plate& nominal,
                                    int tag_id) {
    std::map<int, Difference> differences;
    for (const Snapshot& snapshot : snapshots) add_image(snapshot, nominal, tag_id, differences);
    if (differences.empty())
        return failure(Reason::no_tag,
                       fmt::format("no other fiducial was seen together with fiducial {}", tag_id));

    const auto n = static_cast<double>(differences.size());
    Eigen::Array2d mean{0.0, 0.0}, variance{0.0, 0.0}, spread{0.0, 0.0};
    Eigen::Array2d low = differences.begin()->second.mean_um(), high = low;
    VectorByCamera by_camera = VectorByCamera::Zero();
    Placement placement;
    for (const auto& [id, difference] : differences) {
        placement.neighbours.push_back(id);
        mean += difference.mean_um() / n;
        variance += difference.variance_um2() / (n * n);
        by_camera += difference.by_camera() / n;
        low = low.min(difference.mean_um());
        high = high.max(difference.mean_um());
    }
    if (n > 1.0)
        for (const auto& [id, difference] : differences)
            spread += (difference.mean_um() - mean).square() / (n - 1.0);
    const CameraCovariance& calibration = snapshots.front().image.camera.geometry_covariance;
    const Eigen::Array2d calibration_um2 =
        vector_covariance_mm2(by_camera, calibration).diagonal().array() * um_per_mm * um_per_mm;
    const Eigen::Array2d std = (variance + spread / n + calibration_um2).sqrt();
    placement.x_um = {mean.x(), std.x()};
    placement.y_um = {mean.y(), std.y()};
    placement.disagreement_um = (high - low).matrix();
    return placement;
}

}  // namespace fidservo::inspect
