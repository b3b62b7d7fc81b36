// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/live/live_board.h"

#include "core/rig.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo {

namespace {

constexpr std::size_t most_points = 3000;
constexpr int shown_width_px = 960;
constexpr int jpeg_quality = 80;

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.5g}", value) : "null";
}

std::shared_ptr<const std::string> jpeg_of(const cv::Mat& image) {
    cv::Mat shown = image;
    if (image.cols > shown_width_px)
        cv::resize(image, shown, {shown_width_px, image.rows * shown_width_px / image.cols}, 0, 0,
                   cv::INTER_AREA);
    const std::vector<unsigned char> bytes = vision::encode_jpeg(shown, jpeg_quality);
    return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

nlohmann::json tags_of(const LivePicture& picture) {
    nlohmann::json tags = nlohmann::json::array();
    for (const TagDetection& tag : picture.tags) {
        nlohmann::json corners = nlohmann::json::array();
        for (const Eigen::Vector2d& corner : tag.corners_px) corners.push_back({corner.x(), corner.y()});
        tags.push_back({{"id", tag.tag_id}, {"corners", corners}});
    }
    return {{"width", picture.frame.image.cols},
            {"height", picture.frame.image.rows},
            {"time_s", seconds(picture.frame.time_ns)},
            {"tags", tags}};
}

nlohmann::json json_of(const LiveState& state) {
    nlohmann::json sites = nlohmann::json::array();
    for (const LiveSite& site : state.sites)
        sites.push_back({{"id", site.id}, {"x_mm", site.x_mm}, {"state", site.state}});
    return {{"run", state.run}, {"activity", state.activity}, {"reason", state.reason}, {"sites", sites}};
}

}  // namespace

LiveBoard::LiveBoard(std::shared_ptr<LiveFeed> feed, const Rig& rig)
    : feed_(std::move(feed)), count_mm_(rig.macro.encoder_resolution_mm) {
    if (rig.micro) micro_ = nominal_micro_model(*rig.micro);
}

std::string LiveBoard::point_json(const StageRow& row) const {
    const double platform_mm = micro_ ? platform_position_mm(*micro_, row.hall_adc) : NAN;
    return fmt::format("[{:.3f},{},{},{},{}]", seconds(row.time_ns), number(row.encoder_count * count_mm_),
                       number(row.macro_command_V), number(platform_mm), number(row.micro_command_V));
}

void LiveBoard::collect() {
    std::vector<StageRow> rows;
    feed_->take_points(rows);
    const auto picture = feed_->take_picture();
    const auto state = feed_->take_state();
    if (rows.empty() && !picture && !state) return;
    std::vector<std::string> points;
    std::ranges::transform(rows, std::back_inserter(points),
                           [&](const StageRow& row) { return point_json(row); });
    const auto jpeg = picture ? jpeg_of(picture->frame.image) : nullptr;
    {
        const std::lock_guard lock(mutex_);
        for (std::string& point : points) points_.push_back(std::move(point));
        points_so_far_ += points.size();
        while (points_.size() > most_points) points_.pop_front();
        if (picture) {
            jpeg_ = jpeg;
            tags_json_ = tags_of(*picture).dump();
            ++pictures_;
        }
        if (state) {
            state_json_ = json_of(*state).dump();
            ++states_;
        }
    }
    has_news_.notify_all();
}

std::string LiveBoard::points_json(Told& told) const {
    const std::uint64_t first = points_so_far_ - points_.size();
    std::string text;
    for (std::uint64_t k = std::max(told.points, first); k < points_so_far_; ++k)
        text += (text.empty() ? "" : ",") + points_[static_cast<std::size_t>(k - first)];
    told.points = points_so_far_;
    return "[" + text + "]";
}

std::string LiveBoard::news(Told& told, double longest_s) const {
    std::unique_lock lock(mutex_);
    const auto is_news = [&] {
        return points_so_far_ > told.points || pictures_ > told.picture || states_ > told.state;
    };
    if (!has_news_.wait_for(lock, std::chrono::duration<double>(longest_s), is_news)) return {};
    std::string text = fmt::format(R"({{"points":{})", points_json(told));
    if (pictures_ > told.picture) text += fmt::format(R"(,"number":{},"picture":{})", pictures_, tags_json_);
    if (states_ > told.state) text += fmt::format(R"(,"state":{})", state_json_);
    told.picture = pictures_;
    told.state = states_;
    return text + "}";
}

std::shared_ptr<const std::string> LiveBoard::picture() const {
    const std::lock_guard lock(mutex_);
    return jpeg_;
}

}  // namespace fidservo
