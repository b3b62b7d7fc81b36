#include "gap/clear_detections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// How far a tag is from the nearest side of the image, px.
double to_border_px(const TagDetection& tag, const CameraGeometry& image) {
    double nearest_px = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& corner : tag.corners_px)
        nearest_px = std::min({nearest_px, corner.x(), corner.y(), image.width_px - 1.0 - corner.x(),
                               image.height_px - 1.0 - corner.y()});
    return nearest_px;
}

}  // namespace

void drop_unclear(Recording& recording, std::span<const double> velocity_mm_per_s,
                  const CameraParameters& camera, const FiducialParameters& fiducials, double exposure_s) {
    constexpr double most_cells = 0.15, least_border_cells = 0.5, cells = 8.0, late = 1.5;
    const double cell_mm = fiducials.side_mm / cells;
    std::vector<TagDetection>& detections = recording.detections;
    std::vector<double> smear_cells(detections.size());  // while a frame is exposed
    std::vector<bool> is_cut(detections.size());
    std::vector<int> neighbours(detections.size());
    std::map<int, std::size_t> last;
    for (std::size_t k = 0; k < detections.size(); ++k) {
        const TagDetection& now = detections[k];
        const auto after = std::ranges::lower_bound(recording.rows, now.time_ns, {}, &StageRow::time_ns);
        const auto row =
            std::min<std::ptrdiff_t>(after - recording.rows.begin(), std::ssize(recording.rows) - 1);
        const double speed_mm_per_s = velocity_mm_per_s[static_cast<std::size_t>(row)];
        smear_cells[k] = exposure_s * std::abs(speed_mm_per_s) / cell_mm;
        const double cell_px = (now.corners_px[1] - now.corners_px[0]).norm() / cells;
        is_cut[k] = to_border_px(now, camera.geometry) < least_border_cells * cell_px;
        const auto [before, is_first] = last.try_emplace(now.tag_id, k);
        const std::size_t at = std::exchange(before->second, k);
        const double since_s = seconds(now.time_ns - detections[at].time_ns);
        if (is_first || since_s <= 0.0 || since_s > late / camera.frame_rate_hz) continue;
        const double way_px = (now.corners_px[0] - detections[at].corners_px[0]).norm();
        const double by_frames = exposure_s / since_s * way_px / cell_px;
        smear_cells[k] = std::max(smear_cells[k], by_frames);
        smear_cells[at] = std::max(smear_cells[at], by_frames);
        ++neighbours[k];
        ++neighbours[at];
    }
    std::vector<TagDetection> judged;
    for (std::size_t k = 0; k < detections.size(); ++k)
        if (smear_cells[k] <= most_cells && !is_cut[k] && neighbours[k] == 2) judged.push_back(detections[k]);
    detections = std::move(judged);
}

}  // namespace fidservo::gap
