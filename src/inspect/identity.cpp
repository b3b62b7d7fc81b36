// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/identity.h"

#include "core/rig.h"
#include "src/files/disk/sha256.h"
#include "src/process/commit.h"

#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::inspect {
namespace {

std::string text_of(const Eigen::Vector2d& v) {
    return fmt::format("({} {})", v.x(), v.y());
}

struct ShapeText {
    std::string operator()(const Dot& dot) const {
        return fmt::format("dot {} {}", text_of(dot.centre_mm), dot.diameter_mm);
    }
    std::string operator()(const Pad& pad) const {
        return fmt::format("pad {} {} {}", text_of(pad.centre_mm), text_of(pad.size_mm), pad.angle_rad);
    }
    std::string operator()(const Line& line) const {
        return fmt::format("line {} {} {}", text_of(line.from_mm), text_of(line.to_mm), line.width_mm);
    }
    std::string operator()(const Scratch& scratch) const {
        std::string text = fmt::format("scratch {}", scratch.width_mm);
        for (const Eigen::Vector2d& point_mm : scratch.points_mm) text += " " + text_of(point_mm);
        return text;
    }
};

std::string camera_text(const CameraParameters& camera) {
    const CameraGeometry& geometry = camera.geometry;
    std::string text = fmt::format(
        "camera {} x {} px, focal {} px, principal point {}, distance {} mm, blur {} px, full well {} e, "
        "read noise {} e, latency {} s\n",
        geometry.width_px, geometry.height_px, geometry.focal_px, text_of(geometry.principal_point_px),
        geometry.distance_mm, camera.blur_px, camera.full_well_e, camera.read_noise_e, camera.latency_s);
    text += fmt::format("focal ratio {}, distortion {}, rotation {} rad, tilt {}, axis {}\n",
                        geometry.focal_ratio, fmt::join(numbers_of(geometry.distortion), " "),
                        geometry.rotation_rad, text_of(geometry.tilt_rad), text_of(geometry.axis_rad));
    return text + fmt::format("exposure {} s, gain spread {}\n", camera.exposure_s, camera.gain_spread);
}

/// The recipe's text and, by their fingerprints, the images that it names.
std::string recipe_fingerprint(const Recipe& recipe) {
    std::set<std::filesystem::path> images;
    for (const Site& site : recipe.sites)
        for (const View& view : site.views)
            for (const Check& check : view.checks)
                if (const auto* reference = std::get_if<ReferenceCheck>(&check);
                    reference && reference->image)
                    images.insert(*reference->image);
    const std::string own = sha256_of_file(recipe.file);
    if (images.empty()) return own;
    std::string all = own;
    for (const auto& image : images) all += sha256_of_file(image);
    return sha256(all);
}

/// Of the plate as it is printed and of the rig as it is, where the simulation's are not the nominal ones.
std::string simulated_fingerprint(const Recipe& recipe, const SessionOptions& session) {
    const std::string printed = recipe.simulation.plate ? sha256_of_file(*recipe.simulation.plate) : "";
    return session.sim_rig_file.empty() ? printed : sha256(printed + sha256_of_file(session.sim_rig_file));
}

}  // namespace

std::string plate_text(const Plate& plate) {
    std::string text = fmt::format("{} paper {} ink {}\n", text_of(plate.print()), plate.paper_reflectance,
                                   plate.ink_reflectance);
    for (const PlateTag& tag : plate.tags)
        text += fmt::format("tag {} {} {} {}\n", tag.id, text_of(tag.centre_mm), tag.side_mm, tag.angle_rad);
    for (const Feature& feature : plate.features)
        text += fmt::format("{} {} {}\n", feature.name, std::visit(ShapeText{}, feature.shape),
                            feature.reflectance);
    return text;
}

std::string calibration_text(const Rig& rig) {
    std::string text;
    if (rig.camera) text += camera_text(*rig.camera);
    text += fmt::format("encoder {} mm\n", rig.macro.encoder_resolution_mm);
    if (rig.micro) {
        const HallParameters& hall = rig.micro->hall;
        text += fmt::format("hall {} V, {} V, {} mm, {} mm, {}, {} bits, {} V\n", hall.mid_V, hall.span_V,
                            hall.centre_mm, hall.half_range_mm, hall.cubic, hall.adc_bits, hall.adc_range_V);
        for (std::size_t peak = 0; rig.micro->fod && peak < rig.micro->fod->nodes(); ++peak)
            for (std::size_t temp = 0; temp <= peak; ++temp)
                text += fmt::format("{} ", rig.micro->fod->node_mm(peak, temp));
    }
    return text;
}

RunIdentity identity_of(const Recipe& recipe, const Rig& rig, const SessionOptions& session) {
    return {.recipe_sha256 = recipe_fingerprint(recipe),
            .rig_sha256 = sha256_of_file(session.rig_file),
            .plate_sha256 = sha256(plate_text(recipe.nominal)),
            .printed_sha256 = simulated_fingerprint(recipe, session),
            .calibration_sha256 = sha256(calibration_text(rig)),
            .seed = session.seed,
            .stage = session.stage,
            .camera = session.camera,
            .version = program_version()};
}

}  // namespace fidservo::inspect
