#include "plant/view/warped_rows.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr double invisible_px = 0.02;  // as in motion_blur.cpp
constexpr double places_per_px = 2.0;
constexpr int most_places = 64;

}  // namespace

WarpedRows::WarpedRows(const Picture& picture, const PixelMap& pixels)
    : picture_(picture),
      pixels_(pixels),
      flat_u_(picture.width),
      flat_v_(picture.width),
      row_(picture.width) {}

void WarpedRows::expose(std::span<const double> s_mm) {
    places_.clear();
    const auto [low, high] = std::minmax_element(s_mm.begin(), s_mm.end());
    if (picture_.map.length_px(*high - *low) < invisible_px) {
        places_.push_back({mean_position(s_mm), 1.0F});
        return;
    }
    const auto intervals = static_cast<int>(s_mm.size()) - 1;
    const int most_parts = std::max(1, most_places / intervals);
    for (int k = 0; k < intervals; ++k) {
        const double step_mm = s_mm[k + 1] - s_mm[k];
        const double step_px = picture_.map.length_px(std::abs(step_mm));
        const int parts = std::min(most_parts, static_cast<int>(std::ceil(places_per_px * step_px)) + 1);
        for (int part = 0; part < parts; ++part)
            places_.push_back({s_mm[k] + step_mm * (part + 0.5) / parts,
                               1.0F / (static_cast<float>(intervals) * static_cast<float>(parts))});
    }
}

/// The row that flat_u_, flat_v_ describe, from one camera position.
void WarpedRows::paint_at(double s_mm) {
    std::fill(row_.begin(), row_.end(), picture_.paper);
    // Successive pixels look at places further and further to the right.
    const auto pixels_within = [&](double centre_u, double half_u) {
        const auto first = std::lower_bound(flat_u_.begin(), flat_u_.end(), centre_u - half_u);
        const auto last = std::upper_bound(first, flat_u_.end(), centre_u + half_u);
        return PixelSpan{static_cast<int>(first - flat_u_.begin()), static_cast<int>(last - flat_u_.begin())};
    };
    for (const Item& item : picture_.items) {
        const Eigen::Vector2d centre = picture_.map.place(item.centre_mm, s_mm);
        const Eigen::Vector2d half = half_extent_px(*item.shape);
        if (centre.y() + half.y() < low_v_ || centre.y() - half.y() > high_v_) continue;
        const PixelSpan across = pixels_within(centre.x(), half.x());
        for (int u = across.first; u < across.last; ++u) {
            float coverage = 0.0F;
            cover(*item.shape, flat_u_[u] - centre.x(), flat_v_[u] - centre.y(), {&coverage, 1});
            row_[u] += coverage * (item.reflectance - row_[u]);
        }
    }
    for (const Glare& spot : picture_.glare) {
        const Eigen::Vector2d centre = picture_.map.place(spot.centre_mm, s_mm);
        const double radius = picture_.map.length_px(spot.radius_mm), reach = Glare::reach_in_radii * radius;
        if (centre.y() + reach < low_v_ || centre.y() - reach > high_v_) continue;
        const PixelSpan across = pixels_within(centre.x(), reach);
        for (int u = across.first; u < across.last; ++u) {
            const double x = (flat_u_[u] - centre.x()) / radius, y = (flat_v_[u] - centre.y()) / radius;
            row_[u] += static_cast<float>(spot.strength * std::exp(-0.5 * (x * x + y * y)));
        }
    }
}

void WarpedRows::paint(int v, std::span<float> mean) {
    for (int u = 0; u < picture_.width; ++u) {
        const Eigen::Vector2d place = pixels_.flat_px(u, v);
        flat_u_[u] = place.x();
        flat_v_[u] = place.y();
    }
    const auto [low, high] = std::minmax_element(flat_v_.begin(), flat_v_.end());
    low_v_ = *low;
    high_v_ = *high;
    std::fill(mean.begin(), mean.end(), 0.0F);
    for (const Place& place : places_) {
        paint_at(place.s_mm);
        for (int u = 0; u < picture_.width; ++u) mean[u] += place.weight * row_[u];
    }
}

}  // namespace fidservo::plant::view
