// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/visited.h"

#include "core/dead_zone.h"
#include "core/micro_model.h"
#include "core/rig.h"
#include "gap/links/tag_link.h"
#include "plant/formulas/formulas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

/// The rows of a recording, as variables for formulas of the carriage and of the wire.
class RowsSeen {
  public:
    RowsSeen(const Evidence& evidence, std::size_t run)
        : rig_(evidence.rig()), rows_(evidence.recordings()[run].rows), course_(evidence.course(run)) {}

    std::size_t size() const { return rows_.size(); }
    double time_s(std::size_t k) const { return seconds(rows_[k].time_ns - rows_.front().time_ns); }
    double place_mm(std::size_t k) const { return course_.position_mm[k]; }
    double speed_mm_per_s(std::size_t k) const { return course_.velocity_mm_per_s[k]; }
    double contraction_mm(std::size_t k) const { return course_.contraction_mm[k]; }

    SeenVariables of_carriage(std::size_t k, double way_mm) const {
        using namespace plant::carriage_variable;
        SeenVariables seen{};
        seen[time] = time_s(k);
        seen[command] = rows_[k].macro_command_V;
        seen[voltage] = dead_zone_V(rig_.macro.dead_zone, rows_[k].macro_command_V);
        seen[place] = place_mm(k);
        seen[speed] = speed_mm_per_s(k);
        seen[direction] = speed_mm_per_s(k) < 0.0 ? -1.0 : 1.0;
        seen[way] = way_mm;
        return seen;
    }

    SeenVariables of_wire(std::size_t k) const {
        using namespace plant::micro_variable;
        SeenVariables seen{};
        seen[time] = time_s(k);
        seen[heater_command] = rows_[k].micro_command_V;
        seen[heater_power] = heater_rise_degC(rig_.micro->heater, rows_[k].micro_command_V);
        seen[wire_temp] = course_.temperature_degC[k];
        seen[room_temp] = rig_.micro->heater.ambient_degC;
        seen[contraction] = contraction_mm(k);
        seen[contraction_rate] = rate(course_.contraction_mm, k);
        seen[platform] = contraction_mm(k);
        seen[place] = place_mm(k);
        seen[speed] = speed_mm_per_s(k);
        seen[acceleration] = rate(course_.velocity_mm_per_s, k);
        seen[drive] = rows_[k].macro_command_V;
        return seen;
    }

  private:
    double rate(const std::vector<float>& values, std::size_t k) const {
        if (k == 0) return 0.0;
        return (static_cast<double>(values[k]) - static_cast<double>(values[k - 1])) / rig_.tick_s;
    }

    const Rig& rig_;
    const std::vector<StageRow>& rows_;
    const Course& course_;
};

std::vector<SeenVariables> of_detections(const Evidence& evidence, std::size_t run) {
    using namespace plant::camera_variable;
    const RowsSeen rows(evidence, run);
    std::vector<SeenVariables> all;
    for (std::size_t k = 0; k < evidence.recordings()[run].detections.size(); ++k) {
        const TagSighting& sighting = evidence.sighting(run, k);
        if (!sighting.is_known) continue;
        const auto row = static_cast<std::size_t>(
            std::clamp(sighting.stamp_s / evidence.rig().tick_s, 0.0, static_cast<double>(rows.size() - 1)));
        const double platform_mm = rows.contraction_mm(row);
        SeenVariables seen{};
        seen[time] = sighting.stamp_s;
        seen[camera_place] = rows.place_mm(row) + (std::isfinite(platform_mm) ? platform_mm : 0.0);
        seen[tag_x] = sighting.centre_mm.x();
        seen[tag_y] = sighting.centre_mm.y();
        all.push_back(seen);
    }
    return all;
}

}  // namespace

std::vector<SeenVariables> variables_along(const Evidence& evidence, plant::Site site, std::size_t run) {
    if (site == plant::Site::camera) return of_detections(evidence, run);
    if (site == plant::Site::micro && !evidence.rig().micro) return {};
    const RowsSeen rows(evidence, run);
    std::vector<SeenVariables> all;
    double way_mm = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double speed_mm_per_s = rows.speed_mm_per_s(k);
        switch (site) {
            case plant::Site::carriage:
                all.push_back(rows.of_carriage(k, way_mm));
                break;
            case plant::Site::encoder:
                all.push_back({rows.place_mm(k)});
                break;
            default:
                all.push_back(rows.of_wire(k));
        }
        if (std::isfinite(speed_mm_per_s)) way_mm += std::abs(speed_mm_per_s) * evidence.rig().tick_s;
    }
    return all;
}

std::vector<double> values_along(const Evidence& evidence, const plant::FormulaCode& code,
                                 std::span<const double> parameters, std::size_t run) {
    plant::Formulas formulas;
    formulas.add(code, parameters);
    const double tick_s = evidence.rig().tick_s;
    const std::size_t count = plant::variables_of(code.port().site).size();
    std::vector<double> values;
    plant::FormulaMemory memory;
    const std::size_t memories = code.effect().memories.size();
    bool has_begun = false;
    for (const SeenVariables& seen : variables_along(evidence, code.port().site, run)) {
        const std::span<const double> variables = std::span(seen).first(count);
        bool is_known = true;
        for (std::size_t k = 0; k < count; ++k)
            is_known = is_known && (!code.uses(k) || std::isfinite(seen[k]));
        if (!is_known) {
            values.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        if (formulas.remember()) {
            if (!has_begun) memory = formulas.start(variables, tick_s);
            has_begun = true;
            formulas.begin_tick(memory, variables, tick_s);
        }
        values.push_back(code.value(variables, std::span(memory.values).first(memories), parameters));
    }
    return values;
}

}  // namespace fidservo::gap
