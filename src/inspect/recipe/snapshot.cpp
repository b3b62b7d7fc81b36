// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/snapshot.h"

#include "core/camera/camera_parameters.h"
#include "src/inspect/recipe/recipe.h"
#include "vision/camera_position.h"

namespace fidservo::inspect {
Result<Snapshot> read_snapshot(const vision::Frame& frame, const CameraParameters& camera,
                               const Plate& nominal, int tag_id, vision::TagDetector& detector) {
    const std::vector<TagDetection> found = detector.detect(frame.image, frame.time_ns);
    const vision::LocateOptions options{.noise = vision::grey_noise(camera)};
    const auto fit = vision::locate_camera(camera.geometry, nominal, frame, found, tag_id, options);
    if (!fit) return tl::make_unexpected(fit.error());
    Snapshot snapshot{{frame.image,
                       camera,
                       {fit->position.s_mm, fit->position.y_mm},
                       {fit->position.s_std_mm, fit->y_std_mm},
                       fit->tag.centre_px},
                      {}};
    for (const TagDetection& tag : found) {
        const PlateTag* known = find_tag(nominal, tag.tag_id);
        if (known == nullptr) continue;
        const auto refined = vision::refine_tag(frame.image, tag,
                                                vision::refinement_of(camera.geometry, *known, tag, options));
        if (refined) snapshot.tags.push_back(*refined);
    }
    return snapshot;
}

}  // namespace fidservo::inspect
