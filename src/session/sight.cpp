#include "src/session/sight.h"

#include "vision/tag_choice.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo {

Sight::Sight(const CameraGeometry& camera, const Plate& nominal) : camera_(camera), nominal_(nominal) {}

/// Where a tag should be in the image, with room for what the registration does not know.
cv::Rect Sight::region_of(const PlateTag& tag, double s_mm) const {
    constexpr double room_mm = 0.4;
    const Eigen::Vector2d middle_px = project(camera_, tag.centre_mm, s_mm);
    const double half_px = (0.75 * tag.side_mm + room_mm) / mm_per_px(camera_);
    const cv::Point corner(static_cast<int>(middle_px.x() - half_px),
                           static_cast<int>(middle_px.y() - half_px));
    const int side_px = static_cast<int>(2.0 * half_px);
    return cv::Rect(corner, cv::Size(side_px, side_px)) & cv::Rect(0, 0, camera_.width_px, camera_.height_px);
}

Result<vision::PositionFit> Sight::locate(const vision::Frame& frame, double expected_s_mm,
                                          std::optional<int> preferred_tag) {
    const std::vector<PlateTag> expected = vision::visible_tags(camera_, nominal_, expected_s_mm);
    if (expected.empty())
        return failure(Reason::no_tag,
                       fmt::format("no fiducial of the plate is in view at {:.3f} mm", expected_s_mm));
    PlateTag tag = expected.front();
    for (const PlateTag& visible : expected)
        if (visible.id == preferred_tag) tag = visible;
    found_ = detector_.detect(frame.image, frame.time_ns, region_of(tag, expected_s_mm));
    const bool there =
        std::any_of(found_.begin(), found_.end(), [&](const TagDetection& t) { return t.tag_id == tag.id; });
    if (!there) found_ = detector_.detect(frame.image, frame.time_ns);
    vision::LocateOptions options;
    options.predicted_s_mm = expected_s_mm;
    return vision::locate_camera(camera_, nominal_, frame, found_, tag.id, options);
}

vision::ServoMove Sight::move_to(const vision::PositionFit& seen, double target_s_mm) const {
    vision::ServoParameters law;
    law.camera = camera_;
    const PlateTag tag = vision::find_tag(nominal_, seen.position.tag_id).value();
    return vision::servo_law(
        law, {seen.tag.detection.corners_px, seen.tag.covariance_px2, vision::corners_mm(tag)}, target_s_mm);
}

Result<vision::PositionFit> Sight::locate_anywhere(const vision::Frame& frame) {
    found_ = detector_.detect(frame.image, frame.time_ns);
    const auto way_px = [&](const TagDetection& tag) {
        return (vision::centre_px(tag) - camera_.principal_point_px).norm();
    };
    const TagDetection* nearest = nullptr;
    for (const TagDetection& tag : found_)
        if (vision::find_tag(nominal_, tag.tag_id) && (nearest == nullptr || way_px(tag) < way_px(*nearest)))
            nearest = &tag;
    if (nearest != nullptr) return vision::locate_camera(camera_, nominal_, frame, found_, nearest->tag_id);
    if (!found_.empty())
        return failure(Reason::wrong_tag, fmt::format("tag {} is not on the plate", found_.front().tag_id));
    return failure(Reason::no_tag, "no fiducial in view");
}

}  // namespace fidservo
