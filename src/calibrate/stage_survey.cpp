// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/stage_survey.h"

#include "core/failure.h"
#include "core/rig.h"
#include "vision/grey_noise.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr double settle_s = 0.06;
constexpr double reading_s = 0.02;  ///< to either side of the exposure
constexpr double frame_timeout_s = 0.5;
constexpr double golden = 0.6180339887498949;

std::optional<calib::SeenTag> same_tag(const calib::StageView& view, int id) {
    const auto tag =
        std::ranges::find_if(view, [id](const calib::SeenTag& seen) { return seen.nominal.id == id; });
    if (tag == view.end()) return std::nullopt;
    return *tag;
}

calib::SeenTag seen_tag(const PlateTag& nominal, const vision::RefinedTag& refined) {
    return {nominal, refined.detection.corners_px, refined.covariance_px2, refined.camera_known};
}

Eigen::Vector2d middle_px(const calib::SeenTag& tag) {
    return 0.25 * (tag.corners_px[0] + tag.corners_px[1] + tag.corners_px[2] + tag.corners_px[3]);
}

/// The way that a tag's corners can go at a rate per mm until one of them is `margin_px` from the image's
/// edge.
double way_in_view_mm(const CameraGeometry& camera, const calib::SeenTag& tag,
                      const Eigen::Vector2d& px_per_mm) {
    constexpr double margin_px = 25.0;
    double way_mm = 1e3;
    const Eigen::Vector2d size(camera.width_px - 1.0, camera.height_px - 1.0);
    for (const Eigen::Vector2d& corner : tag.corners_px)
        for (int axis = 0; axis < 2; ++axis) {
            const double rate = px_per_mm(axis);
            const double room = rate > 0.0 ? size(axis) - margin_px - corner(axis) : corner(axis) - margin_px;
            if (std::abs(rate) > 1.0) way_mm = std::min(way_mm, room / std::abs(rate));
        }
    return way_mm;
}

}  // namespace

std::string_view name_of(StageMove move) {
    constexpr std::array names{"growing", "travel", "extended", "platform", "fresh travel", "fresh platform"};
    return names.at(static_cast<std::size_t>(move));
}

double StageShot::hall_mean() const {
    return std::accumulate(hall_adc.begin(), hall_adc.end(), 0.0) / static_cast<double>(hall_adc.size());
}

void refine_again(const CameraParameters& rig_camera, const CameraGeometry& camera,
                  std::vector<StageShot>& shots) {
    vision::RefinementOptions options;
    options.noise = vision::grey_noise(rig_camera);
    options.camera = camera;
    for (StageShot& shot : shots) {
        if (shot.image.empty()) continue;
        calib::StageView again;
        for (const calib::SeenTag& seen : shot.tags) {
            const TagDetection start{
                .tag_id = seen.nominal.id, .corners_px = seen.corners_px, .print = seen.nominal.print};
            const auto refined = vision::refine_tag(shot.image, start, options);
            if (refined && refined->explained >= vision::enough_to_measure)
                again.push_back(seen_tag(seen.nominal, *refined));
        }
        shot.tags = std::move(again);
    }
    std::erase_if(shots, [](const StageShot& shot) { return shot.tags.empty(); });
}

StageSurvey::StageSurvey(Pilot& pilot, const StagePlan& plan)
    : pilot_(pilot), plan_(plan), detector_(vision::machine_camera_options({pilot.nominal.print()})) {}

std::size_t StageSurvey::expected_shots() const {
    constexpr int of_growing = 13;
    const int stands = (plan_.growing ? of_growing : 0) + plan_.travel + 1 + plan_.platform_up +
                       plan_.platform_down + plan_.fresh_travel + plan_.fresh_platform;
    return static_cast<std::size_t>(stands);
}

Status StageSurvey::tick() {
    return pilot_.machine.tick(
        [&](const control::StageSample& sample) {
            sample_ = sample;
            return control::positioner_update(pilot_.params, pilot_.state, sample, {}).command;
        },
        pilot_.setpoints);
}

Status StageSurvey::wait(double duration_s) {
    for (auto ticks = std::lround(duration_s / pilot_.rig.tick_s); ticks > 0; --ticks)
        if (auto ticked = tick(); !ticked) return ticked;
    return {};
}

Result<calib::StageView> StageSurvey::tags_in(const vision::Frame& frame) {
    const std::vector<TagDetection> found = detector_.detect(frame.image, frame.time_ns);
    vision::RefinementOptions options;
    options.noise = vision::grey_noise(*pilot_.rig.camera);
    calib::StageView view;
    std::vector<TagDetection> measured;
    for (const TagDetection& tag : found) {
        const auto nominal = vision::find_tag(pilot_.nominal, tag.tag_id);
        const bool once = std::ranges::count(found, tag.tag_id, &TagDetection::tag_id) == 1;
        if (!nominal || !once) continue;
        const auto refined = vision::refine_tag(frame.image, tag, options);
        if (!refined || refined->explained < vision::enough_to_measure) continue;
        view.push_back(seen_tag(*nominal, *refined));
        measured.push_back(refined->detection);
    }
    if (auto kept = pilot_.machine.keep(found, measured); !kept) return forward(kept.error());
    return view;
}

/// A frame exposed at rest, with the readings around it.
Result<StageShot> StageSurvey::shoot(StageMove move) {
    if (auto settled = wait(settle_s); !settled) return forward(settled.error());
    std::vector<std::pair<TimeNs, int>> readings;
    const TimeNs from = pilot_.machine.now_ns() + nanoseconds(reading_s);
    const TimeNs end = from + nanoseconds(frame_timeout_s);
    const auto count = sample_.encoder_count;
    while (pilot_.machine.now_ns() <= end) {
        if (auto ticked = tick(); !ticked) return forward(ticked.error());
        readings.emplace_back(sample_.time_ns, sample_.hall_adc);
        const auto frame = pilot_.machine.poll_camera();
        if (!frame) return forward(frame.error());
        if (!*frame || pilot_.exposed_at(**frame) < from) continue;
        if (sample_.encoder_count != count)
            return failure(Reason::not_at_rest, "the carriage moved while a picture was taken");
        auto tags = tags_in(**frame);
        if (!tags) return forward(tags.error());
        StageShot shot{move, seconds((*frame)->time_ns), *std::move(tags), static_cast<double>(count),
                       {},   (*frame)->image.clone()};
        for (const auto& [time_ns, adc] : readings)
            if (std::abs(time_ns - pilot_.exposed_at(**frame)) <= nanoseconds(reading_s))
                shot.hall_adc.push_back(adc);
        return shot;
    }
    return failure(Reason::timeout, "no frame from the camera");
}

Status StageSurvey::keep(Result<StageShot> shot) {
    if (!shot) return forward(shot.error());
    if (!shot->tags.empty()) shots_.push_back(std::move(*shot));
    on_shot_();
    return {};
}

Status StageSurvey::grow_to(double side, const StageShot& first) {
    constexpr double first_step_mm = 0.1, longest_mm = 50.0;
    const CameraGeometry& camera = pilot_.rig.camera->geometry;
    const double home_mm = pilot_.believed_s_mm();
    const auto from_axis = [&](const calib::SeenTag& tag) {
        return (middle_px(tag) - camera.principal_point_px).norm();
    };
    const calib::SeenTag followed = *std::ranges::min_element(first.tags, {}, from_axis);
    double way_mm = first_step_mm;
    for (bool at_edge = false; !at_edge && way_mm < longest_mm;) {
        if (auto carried = pilot_.carry_to(home_mm + side * way_mm); !carried) return carried;
        auto shot = shoot(StageMove::growing);
        if (!shot) return forward(shot.error());
        const auto seen = same_tag(shot->tags, followed.nominal.id);
        const double moved_mm = (shot->count - first.count) * pilot_.params.count_mm;
        if (auto kept = keep(std::move(shot)); !kept) return kept;
        if (!seen || moved_mm == 0.0) break;
        const Eigen::Vector2d px_per_mm = side * (middle_px(*seen) - middle_px(followed)) / moved_mm;
        const double room_mm =
            way_in_view_mm(camera, followed, side * moved_mm > 0.0 ? px_per_mm : -px_per_mm);
        at_edge = way_mm >= room_mm - pilot_.params.count_mm;
        way_mm = std::min(2.0 * way_mm, room_mm);
    }
    return pilot_.carry_to(home_mm);
}

Status StageSurvey::grow() {
    const CameraGeometry& camera = pilot_.rig.camera->geometry;
    const double half_view_mm = 0.5 * camera.width_px * camera.distance_mm / camera.focal_px;
    const Way clear = clear_way();
    const double from_mm = std::max(pilot_.believed_s_mm(), clear.low_mm + half_view_mm);
    if (auto carried = pilot_.carry_to(std::min(from_mm, clear.high_mm - half_view_mm)); !carried)
        return carried;
    const auto first = shoot(StageMove::growing);
    if (!first) return forward(first.error());
    if (first->tags.empty())
        return failure(Reason::no_tag, "no fiducial of the plate is in view after homing");
    if (auto kept = keep(*first); !kept) return kept;
    if (auto grown = grow_to(1.0, *first); !grown) return grown;
    return grow_to(-1.0, *first);
}

StageSurvey::Way StageSurvey::clear_way() const {
    constexpr double unknown_scale = 0.01;  // of the encoder
    const MacroParameters& macro = pilot_.rig.macro;
    const double margin_mm = unknown_scale * (macro.high_mm - macro.low_mm);
    const double platform_mm = pilot_.state.micro.average_mm;
    return {macro.low_mm + margin_mm + platform_mm, macro.high_mm - margin_mm + platform_mm};
}

/// Stands at even distances over what the carriage reaches of the plate, each shifted within the pitch.
Status StageSurvey::travel(StageMove move, int stands, double phase) {
    constexpr double beside_mm = 1.0, pitch_mm = 2.0;
    const auto by_x = [](const PlateTag& tag) { return tag.centre_mm.x(); };
    const auto tags = vision::reachable_rows(pilot_.rig.camera->geometry, pilot_.nominal);
    if (tags.empty()) return failure(Reason::no_tag, "no row of fiducials can be brought into view");
    const Way clear = clear_way();
    const double low = std::max(by_x(*std::ranges::min_element(tags, {}, by_x)) - beside_mm, clear.low_mm);
    const double high = std::min(by_x(*std::ranges::max_element(tags, {}, by_x)) + beside_mm, clear.high_mm);
    int blind = 0;
    for (int i = 0; i < stands; ++i) {
        const double shift = pitch_mm * (std::fmod(phase + golden * i, 1.0) - 0.5);
        const double s_mm = std::clamp(low + (high - low) * (i + phase) / stands + shift, low, high);
        if (auto carried = pilot_.carry_to(s_mm); !carried) return carried;
        auto shot = shoot(move);
        if (!shot) return forward(shot.error());
        blind += shot->tags.empty() ? 1 : 0;
        if (auto kept = keep(std::move(shot)); !kept) return kept;
    }
    if (3 * blind > stands)
        return failure(Reason::no_tag, fmt::format("no fiducial was seen at {} of {} stands", blind, stands));
    return {};
}

Status StageSurvey::move_platform(double to_mm) {
    if (auto caught = pilot_.catch_up(); !caught) return caught;
    control::micro_begin_move(pilot_.params.micro, pilot_.state.micro, to_mm);
    const double timeout_s = pilot_.params.micro.shaping.timeout_s + 1.0;
    return pilot_.step_until([&] { return pilot_.state.micro.phase != control::MicroPhase::approach; },
                             timeout_s, "the platform did not reach its place");
}

Status StageSurvey::relax() {
    constexpr double longest_s = 20.0, look_s = 0.4, still_mm = 0.001;
    if (auto caught = pilot_.catch_up(); !caught) return caught;
    control::micro_switch_off(pilot_.state.micro);
    double before_mm = pilot_.state.micro.average_mm;
    int still = 0;
    for (double waited_s = 0.0; waited_s < longest_s && still < 3; waited_s += look_s) {
        if (auto waited = wait(look_s); !waited) return waited;
        still = std::abs(pilot_.state.micro.average_mm - before_mm) < still_mm ? still + 1 : 0;
        before_mm = pilot_.state.micro.average_mm;
    }
    if (still < 3) return failure(Reason::not_at_rest, "the platform did not relax with the heater off");
    return {};
}

Status StageSurvey::sweep_platform() {
    if (auto relaxed = relax(); !relaxed) return relaxed;
    if (auto kept = keep(shoot(StageMove::extended)); !kept) return kept;
    const double low = pilot_.params.reach_low_mm, way = pilot_.params.reach_high_mm - low;
    const auto visit = [&](StageMove move, double share) -> Status {
        if (auto moved = move_platform(low + share * way); !moved) return moved;
        return keep(shoot(move));
    };
    for (int i = 0; i < plan_.platform_up; ++i)
        if (auto done = visit(StageMove::platform, (i + 0.5) / plan_.platform_up); !done) return done;
    for (int i = 0; i < plan_.platform_down; ++i)
        if (auto done = visit(StageMove::platform, 1.0 - (i + 1.0) / (plan_.platform_down + 1.0)); !done)
            return done;
    for (int i = 1; i <= plan_.fresh_platform; ++i)
        if (auto done = visit(StageMove::fresh_platform, std::fmod(golden * i, 1.0)); !done) return done;
    return {};
}

Result<std::vector<StageShot>> StageSurvey::run(const std::function<void()>& on_shot) {
    constexpr double phase = 0.5, fresh_phase = 0.21;
    shots_.clear();
    on_shot_ = on_shot;
    const auto done = [&]() -> Status {
        if (plan_.growing)
            if (auto grown = grow(); !grown) return grown;
        if (auto gone = travel(StageMove::travel, plan_.travel, phase); !gone) return gone;
        if (plan_.fresh_travel > 0)
            if (auto gone = travel(StageMove::fresh_travel, plan_.fresh_travel, fresh_phase); !gone)
                return gone;
        return sweep_platform();
    }();
    if (!done) return forward(done.error());
    return std::move(shots_);
}

}  // namespace fidservo
