// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "gap/balance/hat_functions.h"
#include "gap/balance/tag_period.h"
#include "gap/links/tag_sight.h"
#include "gap/residuals/surrogate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace fidservo::gap {
namespace {

using CornerPattern = std::function<CornerValues(const TagSight&)>;  ///< of corners, px
using Along = std::function<double(const TagSight&)>;                ///< along the motion, px

class TagColumns {
  public:
    explicit TagColumns(const Evidence& evidence) {
        for (const Window& window : evidence.windows()) {
            if (window.signal != Signal::tag) continue;
            size_ = std::max(size_, window.end);
            for (std::size_t i = 0; window.begin + corner_values * i < window.end; ++i)
                sights_.push_back({window.begin + corner_values * i,
                                   sight_of(evidence, window.run, window.first_detection + i)});
        }
    }

    Column of_corners(Dependence group, const CornerPattern& pattern) const {
        return over_sights(group, [&](const TagSight& sight, float* values) {
            const CornerValues there = turned(sight.tag, pattern(sight)).cwiseQuotient(sight.tag.floors_px);
            for (Eigen::Index i = 0; i < there.size(); ++i) values[i] = static_cast<float>(there[i]);
        });
    }

    /// Centres of the tags that several recordings show, mm: what one of them says of a tag, another can
    /// judge.
    std::vector<Eigen::Vector2d> shared_tags() const {
        std::map<std::pair<double, double>, std::set<std::size_t>> runs_of;
        for (const auto& [at, sight] : sights_)
            runs_of[{sight.tag.centre_mm.x(), sight.tag.centre_mm.y()}].insert(sight.run);
        std::vector<Eigen::Vector2d> centres_mm;
        for (const auto& [centre_mm, runs] : runs_of)
            if (runs.size() > 1) centres_mm.emplace_back(centre_mm.first, centre_mm.second);
        return centres_mm;
    }

    Column along(Dependence group, const Along& place) const {
        return over_sights(group, [&](const TagSight& sight, float* values) {
            values[0] = static_cast<float>(place(sight) / sight.tag.floors_px[0]);
        });
    }

    std::vector<float> all(const Along& quantity) const {
        std::vector<float> values;
        values.reserve(sights_.size());
        for (const auto& [at, sight] : sights_) values.push_back(static_cast<float>(quantity(sight)));
        return values;
    }

  private:
    Column over_sights(Dependence group, const std::function<void(const TagSight&, float*)>& fill) const {
        Column column{static_cast<int>(group), std::vector<float>(size_, 0.0F)};
        for (const auto& [at, sight] : sights_) fill(sight, &column.values[at]);
        return column;
    }

    std::size_t size_ = 0;
    std::vector<std::pair<std::size_t, TagSight>> sights_;  ///< with where their values begin in Errors
};

/// A pattern by where a corner is from the image's middle, in halves of its width.
CornerPattern by_image_place(const CameraGeometry& camera,
                             const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& shift) {
    return [&camera, shift](const TagSight& sight) {
        CornerValues values;
        for (int c = 0; c < corner_count; ++c)
            values.segment<2>(2 * c) =
                shift((sight.tag.corners_px.segment<2>(2 * c) - camera.principal_point_px) /
                      (0.5 * camera.width_px));
        return values;
    };
}

/// Displacement of the corners, px, when the tag is enlarged about its centre so that each corner moves
/// outwards by 1 px.
CornerValues larger(const TagSight& sight) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (int c = 0; c < corner_count; ++c) middle += corner_share * sight.tag.corners_px.segment<2>(2 * c);
    CornerValues values;
    for (int c = 0; c < corner_count; ++c)
        values.segment<2>(2 * c) = (sight.tag.corners_px.segment<2>(2 * c) - middle).normalized();
    return values;
}

/// Displacement of all corners, px, at right angles to the stage's motion in the image; its eight values have
/// the norm 1 px.
CornerValues across(const TagSight& sight) {
    const CornerValues motion = turned(sight.tag, CornerValues::Unit(0));
    CornerValues values;
    for (int c = 0; c < corner_count; ++c)
        values.segment<2>(2 * c) = Eigen::Vector2d(-motion[2 * c + 1], motion[2 * c]);
    return values;
}

/// Where tags are not where the plate's description has them. A plate of another pitch displaces them along
/// the motion, one that is turned across it, both in proportion to a tag's place on the plate, wherever in
/// the image it is seen. Tags that are each misplaced by themselves show across the motion alone, where no
/// false reading of the stages can displace them.
void add_plate(std::vector<Column>& columns, const TagColumns& make) {
    columns.push_back(make.along(Dependence::plate_place,
                                 [](const TagSight& sight) { return hundredth * sight.tag.centre_mm.x(); }));
    columns.push_back(make.of_corners(Dependence::plate_turn, [](const TagSight& sight) {
        return CornerValues(hundredth * sight.tag.centre_mm.x() * across(sight));
    }));
    for (const Eigen::Vector2d& centre_mm : make.shared_tags())
        columns.push_back(make.of_corners(Dependence::tag_itself, [&](const TagSight& sight) {
            return CornerValues(sight.tag.centre_mm == centre_mm ? across(sight) : CornerValues::Zero());
        }));
}

void add_tag_hats(std::vector<Column>& columns, const TagColumns& make, Dependence group, std::size_t count,
                  const Along& quantity) {
    const std::vector<double> knots = knots_by_share(make.all(quantity), count);
    if (knots.size() < 2) return;
    for (std::size_t k = 0; k < knots.size(); ++k)
        columns.push_back(
            make.along(group, [&, k](const TagSight& sight) { return hat(knots, k, quantity(sight)); }));
}

void add_image_places(std::vector<Column>& columns, const TagColumns& make, const CameraGeometry& camera) {
    using Place = Eigen::Vector2d;
    const auto add = [&](const std::function<Place(const Place&)>& shift) {
        columns.push_back(make.of_corners(Dependence::image_place, by_image_place(camera, shift)));
    };
    add([](const Place&) { return Place(1.0, 0.0); });
    add([](const Place&) { return Place(0.0, 1.0); });
    add([](const Place& at) { return at; });
    add([](const Place& at) { return Place(-at.y(), at.x()); });
    add([](const Place& at) { return Place(at.x(), -at.y()); });
    add([](const Place& at) { return Place(at.x() * at.x(), at.x() * at.y()); });
    add([](const Place& at) { return Place(at.x() * at.y(), at.y() * at.y()); });
    add([](const Place& at) { return Place(at * at.squaredNorm()); });
}

}  // namespace

Surrogate tag_surrogate(const Evidence& evidence, const Errors& errors) {
    const TagColumns make(evidence);
    Surrogate surrogate{
        Signal::tag, {}, {make.along(Dependence::position, [](const TagSight&) { return 1.0; })}};
    surrogate.as_good = nearly_as_good;
    std::vector<Column>& columns = surrogate.columns;
    columns.push_back(make.along(Dependence::velocity,
                                 [](const TagSight& sight) { return hundredth * sight.velocity_mm_per_s; }));
    columns.push_back(make.along(Dependence::velocity, [](const TagSight& sight) {
        return thousandth * sight.time_s * sight.velocity_mm_per_s;
    }));
    add_tag_hats(columns, make, Dependence::position, rail_hats,
                 [](const TagSight& sight) { return sight.position_mm; });
    columns.push_back(make.along(Dependence::position_share,
                                 [](const TagSight& sight) { return hundredth * sight.position_mm; }));
    surrogate.period_mm = strongest_tag_period_mm(evidence, errors);
    if (surrogate.period_mm > 0.0)
        for (const double phase : {0.0, 0.5 * std::numbers::pi})
            columns.push_back(make.along(Dependence::reading_period, [&](const TagSight& sight) {
                return std::sin(2.0 * std::numbers::pi * sight.position_mm / surrogate.period_mm + phase);
            }));
    if (evidence.rig().micro)
        add_tag_hats(columns, make, Dependence::contraction, wire_hats,
                     [](const TagSight& sight) { return sight.contraction_mm; });
    columns.push_back(make.of_corners(
        Dependence::image_share,
        by_image_place(evidence.rig().camera->geometry, [](const Eigen::Vector2d& at) { return at; })));
    add_image_places(columns, make, evidence.rig().camera->geometry);
    columns.push_back(make.of_corners(Dependence::tag_size, larger));
    add_plate(columns, make);
    return surrogate;
}

}  // namespace fidservo::gap
