// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/straight_rows.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

PixelSpan pixels_within(double centre, double half, PixelSpan limits) {
    const int first = std::max(limits.first, static_cast<int>(std::ceil(std::max(centre - half, -1e9))));
    const int last = std::min(limits.last, static_cast<int>(std::floor(std::min(centre + half, 1e9))) + 1);
    return {first, std::max(first, last)};
}

}  // namespace

bool is_at_rest(const Picture& picture, std::span<const double> s_mm) {
    const auto [low, high] = std::minmax_element(s_mm.begin(), s_mm.end());
    return picture.map.length_px(*high - *low) < invisible_motion_px;
}

void StraightRows::expose(std::span<const double> s_mm) {
    const double mean_s_mm = mean_position(s_mm);
    std::vector<double> shifts_px;
    shifts_px.reserve(s_mm.size());
    for (const double s : s_mm) shifts_px.push_back(picture_.map.shift_px(s - mean_s_mm));
    motion_ = MotionKernel(shifts_px);
    margin_ = motion_.reach();
    row_.resize(static_cast<std::size_t>(picture_.width) + 2 * static_cast<std::size_t>(margin_));
    coverage_.resize(row_.size());
    place_items(mean_s_mm);
    place_glare(mean_s_mm);
}

/// What can be seen in some row, with the margin at both sides of the image.
void StraightRows::place_items(double s_mm) {
    placed_.clear();
    for (const Item& item : picture_.items) {
        const Eigen::Vector2d centre = picture_.map.place(item.centre_mm, s_mm);
        const Eigen::Vector2d half = half_extent_px(*item.shape);
        const PixelSpan across = pixels_within(centre.x(), half.x(), {-margin_, picture_.width + margin_});
        const PixelSpan down = pixels_within(centre.y(), half.y(), {0, picture_.height});
        if (across.first == across.last || down.first == down.last) continue;
        placed_.push_back({item.shape.get(), item.reflectance, centre, across, down});
    }
}

void StraightRows::place_glare(double s_mm) {
    const auto profile = [](PixelSpan pixels, double centre, double radius, double peak) {
        std::vector<float> values;
        for (int k = pixels.first; k < pixels.last; ++k) {
            const double x = (k - centre) / radius;
            values.push_back(static_cast<float>(peak * std::exp(-0.5 * x * x)));
        }
        return values;
    };
    glare_.clear();
    for (const Glare& spot : picture_.glare) {
        const Eigen::Vector2d centre = picture_.map.place(spot.centre_mm, s_mm);
        const double radius = picture_.map.length_px(spot.radius_mm), half = Glare::reach_in_radii * radius;
        const PixelSpan across = pixels_within(centre.x(), half, {-margin_, picture_.width + margin_});
        const PixelSpan down = pixels_within(centre.y(), half, {0, picture_.height});
        if (across.first == across.last || down.first == down.last) continue;
        glare_.push_back({across, down, profile(across, centre.x(), radius, 1.0),
                          profile(down, centre.y(), radius, spot.strength)});
    }
}

float* StraightRows::begin_writing(PixelSpan across) {
    painted_.first = std::min(painted_.first, across.first + margin_);
    painted_.last = std::max(painted_.last, across.last + margin_);
    return row_.data() + across.first + margin_;
}

void StraightRows::paint(const Placed& item, int v) {
    const int length = item.across.last - item.across.first;
    const std::span<float> coverage(coverage_.data(), static_cast<std::size_t>(length));
    cover(*item.shape, item.across.first - item.centre_px.x(), v - item.centre_px.y(), coverage);
    float* const row = begin_writing(item.across);
    for (int i = 0; i < length; ++i) row[i] += coverage[i] * (item.reflectance - row[i]);
}

void StraightRows::add(const PlacedGlare& glare, int v) {
    float* const row = begin_writing(glare.across);
    const float strength = glare.profile_down[v - glare.down.first];
    for (std::size_t i = 0; i < glare.profile_across.size(); ++i)
        row[i] += strength * glare.profile_across[i];
}

/// The row after motion, without the margins.
void StraightRows::average(std::span<float> mean) const {
    if (motion_.is_identity()) {
        std::copy_n(row_.begin() + margin_, mean.size(), mean.begin());
        return;
    }
    const int reach = motion_.reach();
    std::fill(mean.begin(), mean.end(), picture_.paper);
    const int first = std::max(painted_.first - margin_ - reach, 0);
    const int last = std::min(painted_.last - margin_ + reach, static_cast<int>(mean.size()));
    if (first >= last) return;
    const auto length = static_cast<std::size_t>(last - first);
    motion_.apply({row_.data() + first + margin_ - reach, length + 2 * static_cast<std::size_t>(reach)},
                  mean.subspan(first, length));
}

void StraightRows::paint(int v, std::span<float> mean) {
    std::fill(row_.begin(), row_.end(), picture_.paper);
    painted_ = {static_cast<int>(row_.size()), 0};
    for (const Placed& item : placed_)
        if (item.down.contains(v)) paint(item, v);
    for (const PlacedGlare& spot : glare_)
        if (spot.down.contains(v)) add(spot, v);
    average(mean);
}

}  // namespace fidservo::plant::view
