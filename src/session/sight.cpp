// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/sight.h"

#include "core/camera/camera_parameters.h"
#include "core/camera/camera_slopes.h"
#include "core/failure.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

vision::TagTrackerOptions tracker_options(const Plate& nominal) {
    vision::TagTrackerOptions options;
    options.detector = vision::machine_camera_options({nominal.print()});
    return options;
}

}  // namespace

Sight::Sight(const CameraParameters& camera, const Plate& nominal)
    : camera_(camera.geometry),
      noise_(vision::grey_noise(camera)),
      nominal_(nominal),
      tracker_(tracker_options(nominal)) {}

/// Where a tag should be in the image, with room for what the registration does not know.
vision::ExpectedTag Sight::expected(const PlateTag& tag, double s_mm) const {
    constexpr double room_mm = 0.4;
    const Eigen::Vector2d middle_px = project(camera_, tag.centre_mm, s_mm);
    vision::ExpectedTag place{tag.id, {}, room_mm / mm_per_px_at(camera_, middle_px, s_mm), tag.print};
    const auto corners = vision::corners_mm(tag);
    for (std::size_t k = 0; k < 4; ++k) place.corners_px[k] = project(camera_, corners[k], s_mm);
    return place;
}

void Sight::look_for(const vision::Frame& frame, const std::vector<vision::ExpectedTag>& expected) {
    found_.clear();
    refined_.reset();
    for (const vision::FoundTag& tag : tracker_.find(frame.image, frame.time_ns, expected))
        found_.push_back(tag.detection);
}

std::vector<TagDetection> Sight::measured(const vision::Frame& frame) const {
    if (!refined_) return {};
    if (!refined_->camera_known) return {refined_->detection};
    vision::RefinementOptions free;
    free.noise = noise_;
    free.blur_px = refined_->blur_px;
    const auto shown = vision::refine_tag(frame.image, refined_->detection, free);
    if (!shown) return {};
    return {shown->detection};
}

void Sight::keep_refined(const Result<vision::PositionFit>& fit) {
    if (!fit) return;
    if (fit->tag.explained > 0.0) refined_ = fit->tag;
    for (TagDetection& tag : found_)
        if (tag.tag_id == fit->tag.detection.tag_id) tag = fit->tag.detection;
}

Result<vision::PositionFit> Sight::locate(const vision::Frame& frame, double expected_s_mm,
                                          std::optional<int> preferred_tag) {
    const std::vector<PlateTag> visible = vision::visible_tags(camera_, nominal_, expected_s_mm);
    if (visible.empty())
        return failure(Reason::no_tag,
                       fmt::format("no fiducial of the plate is in view at {:.3f} mm", expected_s_mm));
    PlateTag tag = visible.front();
    for (const PlateTag& other : visible)
        if (other.id == preferred_tag) tag = other;
    look_for(frame, {expected(tag, expected_s_mm)});
    const vision::LocateOptions options{.predicted_s_mm = expected_s_mm, .noise = noise_};
    auto fit = vision::locate_camera(camera_, nominal_, frame, found_, tag.id, options);
    keep_refined(fit);
    return fit;
}

vision::ServoMove Sight::move_to(const vision::PositionFit& seen, double target_s_mm) const {
    vision::ServoParameters law;
    law.camera = camera_;
    const PlateTag tag = vision::find_tag(nominal_, seen.position.tag_id).value();
    return vision::servo_law(
        law, {seen.tag.detection.corners_px, seen.tag.covariance_px2, vision::corners_mm(tag)}, target_s_mm);
}

Result<std::optional<int>> Sight::tag_that_others_confirm() const {
    constexpr double agreement_mm = 0.2;
    struct Candidate {
        int id;
        double s_mm, way_px;
    };
    std::vector<Candidate> candidates;
    for (const TagDetection& tag : found_)
        if (const auto known = vision::find_tag(nominal_, tag.tag_id))
            candidates.push_back({tag.tag_id,
                                  vision::fit_position(camera_, *known, vision::unrefined(tag)).position.s_mm,
                                  (vision::centre_px(tag) - camera_.principal_point_px).norm()});
    if (candidates.empty()) return std::nullopt;
    const auto votes = [&](const Candidate& one) {
        return std::ranges::count_if(candidates, [&](const Candidate& other) {
            return std::abs(other.s_mm - one.s_mm) <= agreement_mm;
        });
    };
    const Candidate best = *std::ranges::max_element(candidates, [&](const Candidate& a, const Candidate& b) {
        return std::pair(votes(a), -a.way_px) < std::pair(votes(b), -b.way_px);
    });
    if (candidates.size() > 1 && votes(best) == 1)
        return failure(
            Reason::wrong_tag,
            fmt::format("tags {} and {} contradict each other: one of them is not where the plate has it",
                        candidates[0].id, candidates[1].id));
    return best.id;
}

Result<vision::PositionFit> Sight::locate_anywhere(const vision::Frame& frame) {
    look_for(frame, {});
    const auto chosen = tag_that_others_confirm();
    if (!chosen) return tl::make_unexpected(chosen.error());
    if (*chosen) {
        auto fit = vision::locate_camera(camera_, nominal_, frame, found_, **chosen, {.noise = noise_});
        keep_refined(fit);
        return fit;
    }
    if (!found_.empty())
        return failure(Reason::wrong_tag, fmt::format("tag {} is not on the plate", found_.front().tag_id));
    return failure(Reason::no_tag, "no fiducial in view");
}

}  // namespace fidservo
