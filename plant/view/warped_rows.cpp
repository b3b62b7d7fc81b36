// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/warped_rows.h"

#include "plant/view/motion_blur.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr double places_per_px = 1.5;
constexpr int most_places = 64;

}  // namespace

WarpedRows::WarpedRows(const Picture& picture, const PixelMap& pixels)
    : picture_(picture),
      pixels_(pixels),
      flat_u_(picture.width),
      flat_v_(picture.width),
      du_(picture.width),
      dv_(picture.width),
      row_(picture.width),
      coverage_(picture.width) {}

void WarpedRows::expose(std::span<const double> s_mm) {
    places_.clear();
    if (is_at_rest(picture_, s_mm)) {
        add_place(mean_position(s_mm), 1.0F);
        return;
    }
    const auto intervals = static_cast<int>(s_mm.size()) - 1;
    const int most_parts = std::max(1, most_places / intervals);
    for (int k = 0; k < intervals; ++k) {
        const double step_mm = s_mm[k + 1] - s_mm[k];
        const double step_px = picture_.map.length_px(std::abs(step_mm));
        const int parts = std::clamp(static_cast<int>(std::ceil(places_per_px * step_px)), 1, most_parts);
        for (int part = 0; part < parts; ++part)
            add_place(s_mm[k] + step_mm * (part + 0.5) / parts,
                      1.0F / (static_cast<float>(intervals) * static_cast<float>(parts)));
    }
}

void WarpedRows::add_place(double s_mm, float weight) {
    Place place{picture_.map.growth(s_mm), weight, {}};
    const auto add = [&](const Placed& thing) {
        const Eigen::AlignedBox2d box(thing.centre_px - thing.half_px, thing.centre_px + thing.half_px);
        if (pixels_.view().intersects(box)) place.things.push_back(thing);
    };
    for (const Item& item : picture_.items)
        add({&item, nullptr, picture_.map.place(item.centre_mm, s_mm),
             half_extent_px(*item.shape) * place.growth});
    for (const Glare& spot : picture_.glare) {
        const double reach_px = Glare::reach_in_radii * picture_.map.length_px(spot.radius_mm) * place.growth;
        add({nullptr, &spot, picture_.map.place(spot.centre_mm, s_mm), Eigen::Vector2d::Constant(reach_px)});
    }
    places_.push_back(std::move(place));
}

// Successive pixels look at places further and further to the right.
PixelSpan WarpedRows::pixels_of(const Placed& thing) const {
    const auto first =
        std::lower_bound(flat_u_.begin(), flat_u_.end(), thing.centre_px.x() - thing.half_px.x());
    const auto last = std::upper_bound(first, flat_u_.end(), thing.centre_px.x() + thing.half_px.x());
    return {static_cast<int>(first - flat_u_.begin()), static_cast<int>(last - flat_u_.begin())};
}

void WarpedRows::paint_thing(const Placed& thing, double growth) {
    const PixelSpan across = pixels_of(thing);
    const int length = across.last - across.first;
    if (length <= 0) return;
    const double per_growth = 1.0 / growth;
    for (int k = 0; k < length; ++k) {
        du_[k] = (flat_u_[across.first + k] - thing.centre_px.x()) * per_growth;
        dv_[k] = (flat_v_[across.first + k] - thing.centre_px.y()) * per_growth;
    }
    float* const row = row_.data() + across.first;
    if (thing.item != nullptr) {
        const auto pixels = static_cast<std::size_t>(length);
        cover_at(*thing.item->shape, {du_.data(), pixels}, {dv_.data(), pixels}, {coverage_.data(), pixels});
        for (int k = 0; k < length; ++k) row[k] += coverage_[k] * (thing.item->reflectance - row[k]);
        return;
    }
    const double radius = picture_.map.length_px(thing.glare->radius_mm);
    for (int k = 0; k < length; ++k) {
        const double x = du_[k] / radius, y = dv_[k] / radius;
        row[k] += static_cast<float>(thing.glare->strength * std::exp(-0.5 * (x * x + y * y)));
    }
}

/// The row that flat_u_, flat_v_ describe, from one camera position.
void WarpedRows::paint_at(const Place& place, PixelMap::Span rows) {
    std::fill(row_.begin(), row_.end(), picture_.paper);
    for (const Placed& thing : place.things)
        if (touches(thing, rows)) paint_thing(thing, place.growth);
}

bool WarpedRows::touches(const Placed& thing, PixelMap::Span rows) {
    return thing.centre_px.y() + thing.half_px.y() >= rows.low_px &&
           thing.centre_px.y() - thing.half_px.y() <= rows.high_px;
}

void WarpedRows::paint(int v, std::span<float> mean) {
    const PixelMap::Span rows = pixels_.rows_of(v);
    const bool is_bare = std::all_of(places_.begin(), places_.end(), [&](const Place& place) {
        return std::none_of(place.things.begin(), place.things.end(),
                            [&](const Placed& thing) { return touches(thing, rows); });
    });
    if (is_bare) {
        std::fill(mean.begin(), mean.end(), picture_.paper);
        return;
    }
    pixels_.places(v, flat_u_, flat_v_);
    std::fill(mean.begin(), mean.end(), 0.0F);
    for (const Place& place : places_) {
        paint_at(place, rows);
        for (int u = 0; u < picture_.width; ++u) mean[u] += place.weight * row_[u];
    }
}

}  // namespace fidservo::plant::view
