// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/visit_json.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

using nlohmann::json;

json json_of(const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
}

std::optional<double> number_from(const json& j) {
    return j.is_null() ? std::nullopt : std::optional(j.get<double>());
}

Outcome outcome_from(const json& j) {
    const auto name = j.get<std::string>();
    for (const Outcome outcome : {Outcome::pass, Outcome::fail, Outcome::not_decidable})
        if (name == name_of(outcome)) return outcome;
    return Outcome::not_measured;
}

Visit::End end_from(const json& j) {
    const auto name = j.get<std::string>();
    for (const Visit::End end : {Visit::End::measured, Visit::End::skipped})
        if (name == name_of(end)) return end;
    return Visit::End::deferred;
}

json json_of(const ResultRow& row) {
    return {{"site", row.site},
            {"view", row.view},
            {"check", row.check},
            {"feature", row.feature},
            {"value", json_of(row.value)},
            {"unit", row.unit},
            {"uncertainty", json_of(row.uncertainty)},
            {"nominal", json_of(row.nominal)},
            {"tolerance", json_of(row.tolerance)},
            {"verdict", name_of(row.verdict)},
            {"reason", row.reason},
            {"image", row.image}};
}

ResultRow row_from(const json& j) {
    return {j.at("site"),
            j.at("view"),
            j.at("check"),
            j.at("feature"),
            number_from(j.at("value")),
            j.at("unit"),
            number_from(j.at("uncertainty")),
            number_from(j.at("nominal")),
            number_from(j.at("tolerance")),
            outcome_from(j.at("verdict")),
            j.at("reason"),
            j.at("image")};
}

json json_of(const Overlay& overlay) {
    json points = json::array();
    for (const Eigen::Vector2d& point_px : overlay.points_px) points.push_back({point_px.x(), point_px.y()});
    return {{"kind", static_cast<int>(overlay.kind)},
            {"outcome", name_of(overlay.outcome)},
            {"closed", overlay.closed},
            {"points_px", points},
            {"label", overlay.label}};
}

Overlay overlay_from(const json& j) {
    Overlay overlay{static_cast<Overlay::Kind>(std::clamp(j.at("kind").get<int>(), 0, 2)),
                    outcome_from(j.at("outcome")),
                    j.at("closed"),
                    {},
                    j.at("label")};
    for (const json& point : j.at("points_px"))
        overlay.points_px.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
    return overlay;
}

json json_of(const ViewResult& view) {
    json overlays = json::array();
    for (const Overlay& overlay : view.overlays) overlays.push_back(json_of(overlay));
    return {{"view", view.view},
            {"image", view.image},
            {"axis_x_mm", view.axis_x_mm},
            {"axis_y_mm", view.axis_y_mm},
            {"overlays", overlays}};
}

ViewResult view_from(const json& j) {
    ViewResult view{j.at("view"), j.at("image"), j.at("axis_x_mm"), j.at("axis_y_mm"), {}};
    for (const json& overlay : j.at("overlays")) view.overlays.push_back(overlay_from(overlay));
    return view;
}

}  // namespace

json json_of(const Visit& visit) {
    json failures = json::array(), rows = json::array(), views = json::array();
    for (const FailedAttempt& failed : visit.failures)
        failures.push_back({{"view", failed.view}, {"reason", failed.reason}, {"text", failed.text}});
    for (const ResultRow& row : visit.rows) rows.push_back(json_of(row));
    for (const ViewResult& view : visit.views) views.push_back(json_of(view));
    return {{"site", visit.site},
            {"again", visit.again},
            {"end", name_of(visit.end)},
            {"failures", failures},
            {"rows", rows},
            {"views", views},
            {"recording", visit.recording},
            {"from_s", visit.from_s},
            {"to_s", visit.to_s},
            {"macro_time_s", visit.macro_time_s},
            {"micro_time_s", visit.micro_time_s}};
}

Visit visit_from(const json& j) {
    Visit visit{j.at("site"),
                j.at("again"),
                end_from(j.at("end")),
                {},
                {},
                {},
                j.at("recording"),
                j.at("from_s"),
                j.at("to_s"),
                j.at("macro_time_s"),
                j.at("micro_time_s")};
    for (const json& failed : j.at("failures"))
        visit.failures.push_back({failed.at("view"), failed.at("reason"), failed.at("text")});
    for (const json& row : j.at("rows")) visit.rows.push_back(row_from(row));
    for (const json& view : j.at("views")) visit.views.push_back(view_from(view));
    return visit;
}

}  // namespace fidservo::inspect
