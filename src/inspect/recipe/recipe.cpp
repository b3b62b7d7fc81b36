// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/recipe.h"

#include "src/files/rig/plate_file.h"
#include "src/files/text/yaml_reader.h"
#include "src/inspect/recipe/pattern.h"
#include "src/inspect/recipe/reach.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

constexpr double usual_search_um = 60.0;
constexpr NumberRange search_range{0.0, 500.0, true};

/// A view as the file has it: features named without the site they belong to.
struct ViewText {
    YamlValue value;
    View view;
};

double tolerance(const YamlValue& map, std::string_view key) {
    return map.at(key).number(positive);
}

double read_search_um(const YamlValue& map, double tolerance_um) {
    const auto search = map.find("search_um");
    if (!search) return std::max(usual_search_um, 1.5 * tolerance_um);
    const double search_um = search->number(search_range);
    if (search_um < tolerance_um) search->fail("must not be smaller than the tolerance");
    return search_um;
}

Check read_mark(const YamlValue& map) {
    map.allow_only({"feature", "centre_tolerance_um", "size_tolerance_um", "search_um"});
    const double centre_um = tolerance(map, "centre_tolerance_um"),
                 size_um = tolerance(map, "size_tolerance_um");
    return MarkCheck{map.at("feature").text(), centre_um, size_um,
                     read_search_um(map, std::max(centre_um, size_um))};
}

Check read_line_check(const YamlValue& map) {
    map.allow_only({"feature", "width_tolerance_um", "search_um"});
    const double width_um = tolerance(map, "width_tolerance_um");
    return LineCheck{map.at("feature").text(), width_um, read_search_um(map, width_um)};
}

Check read_edge_distance(const YamlValue& map) {
    map.allow_only({"between", "tolerance_um", "search_um"});
    const std::vector<YamlValue> between = map.at("between").items();
    if (between.size() != 2) map.at("between").fail("must be a list of two: features, or fiducial");
    const double tolerance_um = tolerance(map, "tolerance_um");
    return EdgeDistanceCheck{between[0].text(), between[1].text(), tolerance_um,
                             read_search_um(map, tolerance_um)};
}

Check read_reference(const YamlValue& map) {
    map.allow_only({"image", "longest_defect_um"});
    ReferenceCheck check{std::nullopt, tolerance(map, "longest_defect_um")};
    if (const auto image = map.find("image")) {
        check.image = image->file();
        if (!std::filesystem::is_regular_file(*check.image)) image->fail("no such file");
    }
    return check;
}

Check read_check(const YamlValue& value) {
    value.allow_only({"fiducial_placement", "mark", "line", "edge_distance", "reference"});
    if (value.keys().size() != 1) value.fail("each check is a list item of its own");
    if (const auto map = value.find("fiducial_placement")) {
        map->allow_only({"tolerance_um"});
        return PlacementCheck{tolerance(*map, "tolerance_um")};
    }
    if (const auto map = value.find("mark")) return read_mark(*map);
    if (const auto map = value.find("line")) return read_line_check(*map);
    if (const auto map = value.find("edge_distance")) return read_edge_distance(*map);
    return read_reference(value.at("reference"));
}

std::vector<ViewText> read_views(const YamlValue& list) {
    std::vector<ViewText> views;
    std::set<std::string> names;
    for (const YamlValue& value : list.items()) {
        value.allow_only({"name", "offset_um", "checks"});
        View view{value.at("name").text(), value.at("offset_um").number(), {}};
        if (view.name.empty() ||
            view.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") != std::string::npos)
            value.at("name").fail("must be made of a-z, 0-9, - and _: it becomes part of file names");
        if (!names.insert(view.name).second) value.at("name").fail("a view of this name exists already");
        for (const YamlValue& check : value.at("checks").items()) view.checks.push_back(read_check(check));
        views.push_back({value, std::move(view)});
    }
    if (views.empty()) list.fail("must have at least one view");
    return views;
}

OnFailure read_on_failure(const YamlValue& map, const OnFailure& usual) {
    map.allow_only({"retries", "then"});
    OnFailure rule = usual;
    if (const auto retries = map.find("retries")) rule.retries = retries->integer(0, 10);
    if (const auto then = map.find("then")) rule.defer = then->one_of({"skip", "defer"}) == 1;
    return rule;
}

std::vector<int> read_site_ids(const YamlValue& value, const Plate& plate) {
    std::vector<int> ids;
    if (value.is_list()) {
        for (const YamlValue& item : value.items()) ids.push_back(item.integer(0, 586));
    } else if (value.is_map()) {
        value.allow_only({"first", "step", "count"});
        const int first = value.at("first").integer(0, 586), step = value.at("step").integer(-586, 586);
        const int count = value.at("count").integer(1, 587);
        if (step == 0 && count > 1) value.at("step").fail("must not be 0");
        for (int k = 0; k < count; ++k) ids.push_back(first + k * step);
    } else {
        value.one_of({"all"});
        for (const PlateTag& tag : plate.tags) ids.push_back(tag.id);
    }
    if (ids.empty()) value.fail("must name at least one fiducial");
    return ids;
}

/// Puts the ids in the order of travel, if the recipe leaves the order to the program.
void put_in_order(std::vector<int>& ids, std::size_t order, const Plate& plate) {
    if (order == 0) return;
    std::stable_sort(ids.begin(), ids.end(), [&](int a, int b) {
        const double xa = find_tag(plate, a)->centre_mm.x(), xb = find_tag(plate, b)->centre_mm.x();
        return order == 1 ? xa < xb : xa > xb;
    });
}

/// A site's own rules: those of `on_failure`, and the views that it is restricted to.
struct SiteRules {
    OnFailure on_failure;
    std::vector<std::string> views;
};

std::map<int, SiteRules> read_exceptions(const YamlValue& list, const OnFailure& usual) {
    std::map<int, SiteRules> rules;
    for (const YamlValue& value : list.items()) {
        value.allow_only({"tag", "on_failure", "views"});
        SiteRules rule{usual, {}};
        if (const auto on_failure = value.find("on_failure"))
            rule.on_failure = read_on_failure(*on_failure, usual);
        if (const auto views = value.find("views"))
            for (const YamlValue& name : views->items()) rule.views.push_back(name.text());
        if (!rules.emplace(value.at("tag").integer(0, 586), rule).second)
            value.at("tag").fail("has an exception already");
    }
    return rules;
}

Recipe read_recipe(const YamlValue& root, const std::filesystem::path& file, const Rig& rig) {
    root.allow_only({"name", "plate", "pattern", "sites", "views", "camera_reconnect_s", "simulation"});
    Recipe recipe{root.at("name").text(), file, read_plate(root.at("plate")), {}, {}};

    const YamlValue sites = root.at("sites");
    sites.allow_only({"tags", "order", "on_failure", "exceptions"});
    const YamlValue tags = sites.at("tags");
    std::vector<int> ids = read_site_ids(tags, recipe.nominal);
    std::set<int> seen;
    for (const int id : ids) {
        if (!find_tag(recipe.nominal, id)) tags.fail(fmt::format("fiducial {} is not on the plate", id));
        if (!seen.insert(id).second) tags.fail(fmt::format("fiducial {} is listed twice", id));
    }
    const auto order = sites.find("order");
    put_in_order(ids, order ? order->one_of({"given", "rightwards", "leftwards"}) : 0, recipe.nominal);
    const auto on_failure = sites.find("on_failure");
    const OnFailure usual = on_failure ? read_on_failure(*on_failure, {}) : OnFailure{};
    std::map<int, SiteRules> exceptions;
    if (const auto list = sites.find("exceptions")) exceptions = read_exceptions(*list, usual);
    for (const auto& [id, rule] : exceptions)
        if (!seen.contains(id)) sites.at("exceptions").fail(fmt::format("fiducial {} is no site", id));

    if (const auto pattern = root.find("pattern")) add_pattern(*pattern, ids, recipe.nominal);
    const std::vector<ViewText> views = read_views(root.at("views"));
    for (const int id : ids) {
        const auto exception = exceptions.find(id);
        Site site{id,
                  find_tag(recipe.nominal, id)->centre_mm,
                  exception == exceptions.end() ? usual : exception->second.on_failure,
                  {}};
        check_fiducial_in_rows(tags, rig, *find_tag(recipe.nominal, id));
        for (const auto& [value, view] : views) {
            if (exception != exceptions.end() && !exception->second.views.empty() &&
                std::ranges::find(exception->second.views, view.name) == exception->second.views.end())
                continue;
            site.views.push_back(of_site(view, recipe.nominal, id));
            check_view(value, rig, recipe.nominal, site, site.views.back());
        }
        if (site.views.empty())
            sites.at("exceptions").fail(fmt::format("no view is left for fiducial {}", id));
        check_placement(root.at("views"), rig, recipe.nominal, site);
        recipe.sites.push_back(std::move(site));
    }
    if (const auto reconnect = root.find("camera_reconnect_s"))
        recipe.camera_reconnect_s = reconnect->number({0.0, 3600.0});
    if (const auto simulation = root.find("simulation")) {
        simulation->allow_only({"plate", "seed"});
        if (const auto plate = simulation->find("plate")) {
            if (!std::filesystem::is_regular_file(plate->file()))
                plate->fail(fmt::format("there is no such file as {}", plate->file().string()));
            recipe.simulation.plate = plate->file();
        }
        if (const auto seed = simulation->find("seed"))
            recipe.simulation.seed = static_cast<std::uint64_t>(seed->integer(0, 2147483647));
    }
    return recipe;
}

}  // namespace

Recipe load_recipe(const std::filesystem::path& file, const Rig& rig) {
    return read_recipe(YamlValue::load(file), file, rig);
}

Recipe parse_recipe(const std::string& text, const std::filesystem::path& file, const Rig& rig) {
    return read_recipe(YamlValue::parse(text, file), file, rig);
}

const Feature* find_feature(const Plate& plate, const std::string& name) {
    const auto found = std::ranges::find(plate.features, name, &Feature::name);
    return found == plate.features.end() ? nullptr : &*found;
}

const PlateTag* find_tag(const Plate& plate, int id) {
    const auto found = std::ranges::find(plate.tags, id, &PlateTag::id);
    return found == plate.tags.end() ? nullptr : &*found;
}

}  // namespace fidservo::inspect
