// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/stretch_result.h"

#include "src/replay/replay_tables.h"

#include <utility>

namespace fidservo::fleet {

using Json = nlohmann::ordered_json;

Json frame_json(const FrameResult& result, const std::string& damage) {
    Json json = Json::object();
    if (result.frame.time_ns) json["time_ns"] = *result.frame.time_ns;
    if (!damage.empty()) {
        json["damage"] = damage;
        return json;
    }
    if (result.frame.orientation != 1) json["orientation"] = result.frame.orientation;
    if (result.frame.has_more_pictures) json["has_more_pictures"] = true;
    Json detections = Json::array(), places = Json::array();
    for (const TagDetection& tag : result.tags) detections.push_back(detection_row(tag));
    for (const vision::RefinedTag& tag : result.refined) {
        const vision::TagPlace place = vision::tag_place(tag);
        places.push_back({place.tag_id, place.centre_px.x(), place.centre_px.y(), place.variance_px2.x(),
                          place.variance_px2.y(), place.side_px, place.side_std_px});
    }
    json["detections"] = std::move(detections);
    json["places"] = std::move(places);
    return json;
}

FrameFound frame_found(const nlohmann::json& json) {
    FrameFound found;
    if (json.contains("time_ns")) found.frame.time_ns = json.at("time_ns").get<TimeNs>();
    found.frame.damage = json.value("damage", "");
    if (!found.frame.damage.empty()) return found;
    found.frame.orientation = json.value("orientation", 1);
    found.frame.has_more_pictures = json.value("has_more_pictures", false);
    found.detections = json.at("detections").get<std::vector<std::string>>();
    for (const nlohmann::json& place : json.at("places"))
        found.places.push_back({.time_ns = found.frame.time_ns.value_or(0),
                                .tag_id = place.at(0).get<int>(),
                                .centre_px = {place.at(1).get<double>(), place.at(2).get<double>()},
                                .variance_px2 = {place.at(3).get<double>(), place.at(4).get<double>()},
                                .side_px = place.at(5).get<double>(),
                                .side_std_px = place.at(6).get<double>()});
    return found;
}

}  // namespace fidservo::fleet
