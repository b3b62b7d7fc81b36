// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/clear_detections.h"

#include "core/rig.h"
#include "gap/evidence/plate_tag.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

constexpr double most_cells = 0.15;  // smear above which a detection is dropped

double cell_px(const TagDetection& tag) {
    return (tag.corners_px[1] - tag.corners_px[0]).norm() / tag.print.outline_cells();
}

bool looks_smeared(const TagAppearance& seen, double cell_px) {
    double least_px2 = std::numeric_limits<double>::infinity(), most_px2 = 0.0;
    int too_wide = 0;
    for (const TagSide& side : seen.sides) {
        if (side.normal.isZero()) ++too_wide;
        if (std::isnan(side.variance_px2)) continue;
        least_px2 = std::min(least_px2, side.variance_px2);
        most_px2 = std::max(most_px2, side.variance_px2);
    }
    const bool is_one_way_only = too_wide > 0 && too_wide < std::ssize(seen.sides);
    return is_one_way_only || uniform_divisor * (most_px2 - least_px2) > std::pow(most_cells * cell_px, 2);
}

/// How far a tag is from the nearest side of the image, px.
double to_border_px(const TagDetection& tag, const CameraGeometry& image) {
    double nearest_px = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& corner : tag.corners_px)
        nearest_px = std::min({nearest_px, corner.x(), corner.y(), image.width_px - 1.0 - corner.x(),
                               image.height_px - 1.0 - corner.y()});
    return nearest_px;
}

}  // namespace

bool refines_corners(const Recording& recording) {
    return std::ranges::any_of(recording.detections,
                               [](const TagDetection& tag) { return tag.is_refined.value_or(false); });
}

TagsInFrames smeared_tags(const Recording& recording) {
    TagsInFrames smeared;
    for (const TagAppearance& seen : recording.appearances) {
        auto tag = std::ranges::lower_bound(recording.detections, seen.time_ns, {}, &TagDetection::time_ns);
        for (; tag != recording.detections.end() && tag->time_ns == seen.time_ns; ++tag)
            if (tag->tag_id == seen.tag_id && looks_smeared(seen, cell_px(*tag)))
                smeared.emplace(seen.time_ns, seen.tag_id);
    }
    return smeared;
}

void drop_unclear(Recording& recording, std::span<const double> velocity_mm_per_s, const Rig& rig,
                  double exposure_s, const TagsInFrames& smeared) {
    constexpr double least_border_cells = 0.5;
    const CameraParameters& camera = *rig.camera;
    std::vector<TagDetection>& detections = recording.detections;
    std::vector<double> smear_cells(detections.size());  // by which the tag moves during the exposure
    std::vector<bool> is_cut(detections.size());
    std::vector<int> neighbours(detections.size());
    std::map<int, std::size_t> last;
    for (std::size_t k = 0; k < detections.size(); ++k) {
        const TagDetection& now = detections[k];
        const auto after = std::ranges::lower_bound(recording.rows, now.time_ns, {}, &StageRow::time_ns);
        const auto row =
            std::min<std::ptrdiff_t>(after - recording.rows.begin(), std::ssize(recording.rows) - 1);
        const double speed_mm_per_s = velocity_mm_per_s[static_cast<std::size_t>(row)];
        if (const auto tag = plate_tag(recording, rig, now.tag_id))
            smear_cells[k] =
                exposure_s * std::abs(speed_mm_per_s) * tag->print.outline_cells() / tag->side_mm;
        is_cut[k] = to_border_px(now, camera.geometry) < least_border_cells * cell_px(now);
        const auto [before, is_first] = last.try_emplace(now.tag_id, k);
        const std::size_t at = std::exchange(before->second, k);
        const double since_s = seconds(now.time_ns - detections[at].time_ns);
        if (is_first || since_s <= 0.0 || since_s > most_steps_apart / camera.frame_rate_hz) continue;
        const double way_px = (now.corners_px[0] - detections[at].corners_px[0]).norm();
        const double by_frames = exposure_s / since_s * way_px / cell_px(now);
        smear_cells[k] = std::max(smear_cells[k], by_frames);
        smear_cells[at] = std::max(smear_cells[at], by_frames);
        ++neighbours[k];
        ++neighbours[at];
    }
    // A program that looks for tags only now and then, and stores no frames, gives detections without
    // neighbours.
    const int least_neighbours = recording.appearances.empty() ? 0 : 2;
    const bool refines = refines_corners(recording);
    std::vector<TagDetection> judged;
    for (std::size_t k = 0; k < detections.size(); ++k)
        if ((!refines || detections[k].is_refined.value_or(true)) && smear_cells[k] <= most_cells &&
            !is_cut[k] && neighbours[k] >= least_neighbours &&
            !smeared.contains({detections[k].time_ns, detections[k].tag_id}))
            judged.push_back(detections[k]);
    detections = std::move(judged);
}

}  // namespace fidservo::gap
