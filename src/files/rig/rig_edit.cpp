// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/rig_edit.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/together.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/camera_info.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/fod_file.h"
#include "src/files/rig/rig_camera.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace fidservo {

namespace fs = std::filesystem;

namespace {

constexpr const char* numerator_key = "velocity_numerator_count_per_V";

std::string digits_of(double value) {
    return fmt::format("{:.9g}", value);
}

/// [a, b, ...] on one line.
YAML::Node list_of(const std::vector<std::string>& values) {
    YAML::Node list(YAML::NodeType::Sequence);
    list.SetStyle(YAML::EmitterStyle::Flow);
    for (const std::string& value : values) list.push_back(value);
    return list;
}

/// Makes the value at a dotted path, below `node`.
void set_below(YAML::Node node, std::string_view key, const YAML::Node& value) {
    const auto dot = key.find('.');
    const std::string first(key.substr(0, dot));
    if (dot == std::string_view::npos)
        node[first] = value;
    else
        set_below(node[first], key.substr(dot + 1), value);
}

bool is_intrinsic(std::string_view key) {
    return std::any_of(intrinsic_camera_keys.begin(), intrinsic_camera_keys.end(),
                       [&](const char* name) { return key == fmt::format("camera.{}", name); });
}

/// Puts the numbers of the file that `camera.camera_info` names in its place.
void copy_camera_info(YAML::Node camera, const fs::path& rig_file) {
    const auto exact = [](double value) { return fmt::format("{}", value); };
    const CameraInfo info =
        load_camera_info(fs::absolute(rig_file).parent_path() / camera["camera_info"].as<std::string>());
    camera.remove("camera_info");
    camera["width_px"] = info.width_px;
    camera["height_px"] = info.height_px;
    camera["focal_px"] = exact(info.focal_px.x());
    camera["focal_ratio"] = exact(info.focal_px.y() / info.focal_px.x());
    camera["principal_point_px"] =
        list_of({exact(info.principal_point_px.x()), exact(info.principal_point_px.y())});
    std::vector<std::string> distortion;
    std::ranges::transform(numbers_of(info.distortion), std::back_inserter(distortion), exact);
    camera["distortion"] = list_of(distortion);
    if (info.distortion.model != LensModel::plumb_bob)
        camera["lens"] = std::string(name_of(info.distortion.model));
}

/// A path that is relative to one file, as one that is relative to another.
void keep_path(YAML::Node value, const fs::path& source, const fs::path& folder) {
    const fs::path target = fs::absolute(source).parent_path() / value.as<std::string>();
    value = fs::proximate(target, folder).string();
}

void demand_new(const fs::path& file) {
    std::error_code error;
    if (fs::symlink_status(file, error).type() != fs::file_type::not_found)
        throw InputError(fmt::format("{}: exists already; give the name of a new file", file.string()));
}

/// The numerator of the transfer function repeats gain, pole, tick and resolution; it follows them.
void update_numerator(YAML::Node root) {
    YAML::Node macro = root["macro"];
    if (!macro[numerator_key]) return;
    const double numerator = macro["velocity_gain_mm_per_s_per_V"].as<double>() *
                             (1.0 - macro["velocity_pole"].as<double>()) * root["tick_s"].as<double>() /
                             macro["encoder_resolution_mm"].as<double>();
    macro[numerator_key] = digits_of(numerator);
}

YAML::Node map_of(const std::vector<std::pair<std::string, double>>& values) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [key, value] : values)
        if (std::isfinite(value)) map[key] = digits_of(value);
    return map;
}

}  // namespace

struct RigEdit::Impl {
    fs::path source;
    YAML::Node root;
    std::vector<StatedEffect> stated;  ///< by the source
    std::shared_ptr<const FodTable> fod;

    /// Of an effect among those that the file states.
    std::optional<std::size_t> place_of(std::string_view effect) const {
        const YAML::Node effects = root["effects"];
        if (!effects) return {};
        for (std::size_t i = 0; i < effects.size(); ++i)
            if (effects[i]["name"].as<std::string>() == effect) return i;
        return {};
    }

    void set(std::string_view key, const YAML::Node& value) {
        if (is_intrinsic(key)) {
            root["camera"].remove("geometry_covariance");  // said of other intrinsics
            if (root["camera"]["camera_info"]) copy_camera_info(root["camera"], source);
        }
        set_below(root, key, value);
    }
};

RigEdit::RigEdit(const fs::path& source) : impl_(std::make_unique<Impl>()) {
    impl_->stated = load_rig(source).effects;
    impl_->source = source;
    impl_->root = YAML::LoadFile(source.string());
}

RigEdit::~RigEdit() = default;

void RigEdit::set(std::string_view key, double value) {
    impl_->set(key, YAML::Node(digits_of(value)));
}

void RigEdit::set(std::string_view key, std::span<const double> values) {
    std::vector<std::string> digits;
    digits.reserve(values.size());
    for (const double value : values) digits.push_back(digits_of(value));
    impl_->set(key, list_of(digits));
}

void RigEdit::set_name(std::string_view key, std::string_view name) {
    impl_->set(key, YAML::Node(std::string(name)));
}

void RigEdit::state_effect(const StatedEffect& effect) {
    YAML::Node entry(YAML::NodeType::Map);
    if (effect.formula) {
        entry = YAML::Load(stated_formula_yaml(effect));
    } else {
        entry.SetStyle(YAML::EmitterStyle::Flow);
        entry["name"] = effect.name;
        for (const StatedEffect::Parameter& parameter : effect.parameters)
            entry[parameter.name] = digits_of(parameter.value);
    }
    YAML::Node effects = impl_->root["effects"];
    if (const auto at = impl_->place_of(effect.name))
        effects[*at] = entry;
    else
        effects.push_back(entry);
}

void RigEdit::add_effect(const StatedEffect& found) {
    const auto at = impl_->place_of(found.name);
    const auto before = std::ranges::find(impl_->stated, found.name, &StatedEffect::name);
    const bool is_refitted =
        before != impl_->stated.end() && before->formula && before->formula == found.formula;
    if (!at || is_refitted) return state_effect(found);
    StatedEffect stated{found.name, {}};
    for (const auto& entry : impl_->root["effects"][*at]) {
        const auto key = entry.first.as<std::string>();
        if (key == "name") continue;
        if (found.formula || !entry.second.IsScalar())
            throw InputError(
                fmt::format("{}: effects: {}: is a formula that the file states already; allowed: "
                            "another name for what acts beside it",
                            impl_->source.string(), found.name));
        stated.parameters.push_back({key, entry.second.as<double>()});
    }
    state_effect(plant::together(stated, found));
}

void RigEdit::set_fod(std::shared_ptr<const FodTable> table) {
    impl_->fod = std::move(table);
}

void RigEdit::set_provenance(const RigProvenance& provenance) {
    YAML::Node part = impl_->root["identified"][provenance.part];
    part["recordings"] = provenance.recordings;
    part["standard_errors"] = map_of(provenance.standard_errors);
    part["residual_rms"] = map_of(provenance.residuals);
    if (!provenance.contradictions.empty()) part["contradictions"] = provenance.contradictions;
}

void RigEdit::save(const fs::path& file) const {
    const Impl& edit = *impl_;
    YAML::Node root = YAML::Clone(edit.root);
    update_numerator(root);
    const fs::path folder = fs::absolute(file).parent_path();
    const fs::path fod_file = folder / (file.stem().string() + "_fod.csv");
    demand_new(file);
    if (edit.fod) {
        demand_new(fod_file);
        root["micro"]["preisach_fod"] = fod_file.filename().string();
    } else if (root["micro"]) {
        keep_path(root["micro"]["preisach_fod"], edit.source, folder);
    }
    if (root["camera"] && root["camera"]["camera_info"])
        keep_path(root["camera"]["camera_info"], edit.source, folder);
    YAML::Emitter text;
    text << root;
    std::error_code error;
    fs::create_directories(folder, error);
    if (edit.fod) write_or_throw(fod_file, fod_text(*edit.fod));
    write_or_throw(file, std::string(text.c_str()) + '\n');
    try {
        load_rig(file);
    } catch (const InputError&) {
        fs::remove(file);
        if (edit.fod) fs::remove(fod_file);
        throw;
    }
}

}  // namespace fidservo
