// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/reference_check.h"

#include "core/camera/camera_parameters.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/units.h"
#include "src/inspect/recipe/outline.h"
#include "vision/images/image_file.h"

#include <cmath>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

/// Room around a defect's ring, so that the ring does not hide it.
constexpr double ring_margin_mm = 0.06;

std::string_view words_for(vision::DefectSign sign) {
    return sign == vision::DefectSign::additional_ink ? "additional ink" : "missing ink";
}

/// The nominal feature that the defect lies on or beside; empty: on bare paper.
std::string feature_at(const CheckContext& context, const vision::Defect& defect) {
    const vision::RestImage& image = context.snapshot.image;
    const Eigen::Vector2d at_px = to_image(image, defect.centre_mm);
    const double near_px = 8.0;
    for (const Feature& feature : context.nominal.features) {
        const Outline outline = outline_of(image, feature);
        Eigen::Array2d low = outline.front(), high = low;
        for (const Eigen::Vector2d& point : outline) {
            low = low.min(point.array());
            high = high.max(point.array());
        }
        if ((at_px.array() > low - near_px).all() && (at_px.array() < high + near_px).all())
            return feature.name;
    }
    return {};
}

ResultRow row_of(const CheckContext& context, const ReferenceCheck& check, const vision::Defect& defect) {
    const vision::RestImage& image = context.snapshot.image;
    const double px_mm = picture_around(image, to_image(image, defect.centre_mm)).mm_per_px;
    const vision::Measured length{defect.length_um, um_from_mm(px_mm) / std::sqrt(6.0)};
    const Eigen::Vector2d at_um = (defect.centre_mm - context.site.fiducial_mm) * um_per_mm;
    const std::string feature = feature_at(context, defect);
    return {context.site.tag_id,
            context.view.name,
            "reference",
            feature.empty() ? "paper" : feature,
            length.value,
            "um",
            length.std,
            0.0,
            check.longest_defect_um,
            outcome_of(vision::decide(length, 0.0, check.longest_defect_um)),
            fmt::format("{} at x {:.0f}, y {:.0f} um from the fiducial, {:.0f} x {:.0f} um",
                        words_for(defect.sign), at_um.x(), at_um.y(), defect.length_um, defect.width_um),
            context.image};
}

}  // namespace

CheckedView compare_view(const CheckContext& context, const ReferenceCheck& check) {
    const vision::RestImage& image = context.snapshot.image;
    const auto reference =
        check.image ? load_reference(*check.image, image.camera, context.nominal, context.site.tag_id)
                    : context.draw_nominal(image.axis_mm);
    const auto compared = vision::compare_with_reference(image, reference);
    const ResultRow whole{
        context.site.tag_id,     context.view.name, "reference", "view",       {}, "um", {}, 0.0,
        check.longest_defect_um, Outcome::pass,     "",          context.image};
    CheckedView checked;
    if (!compared) {
        checked.rows.push_back(whole);
        checked.rows.back().verdict = Outcome::not_decidable;
        checked.rows.back().reason =
            fmt::format("{}: {}", name_of(compared.error().reason), compared.error().text);
        return checked;
    }
    for (const vision::Defect& defect : compared->defects) {
        const ResultRow row = row_of(context, check, defect);
        checked.rows.push_back(row);
        checked.overlays.push_back(
            {Overlay::Kind::defect, row.verdict, true,
             circle(image, defect.centre_mm, mm_from_um(defect.length_um) + 2 * ring_margin_mm),
             fmt::format("{} {:.0f} \u00d7 {:.0f} \u00b5m", words_for(defect.sign), defect.length_um,
                         defect.width_um)});
    }
    if (checked.rows.empty()) {
        checked.rows.push_back(whole);
        checked.rows.back().value = 0.0;
        checked.rows.back().reason = "no difference";
    }
    return checked;
}

vision::ReferenceImage load_reference(const std::filesystem::path& file, const CameraParameters& camera,
                                      const Plate& nominal, int tag_id) {
    const auto read = vision::read_grey(file);
    if (!read) throw InputError(read.error().text);
    const cv::Mat& grey = *read;
    if (grey.cols != camera.geometry.width_px || grey.rows != camera.geometry.height_px)
        throw InputError(fmt::format("{}: {} x {} px; a reference image must have the camera's {} x {}",
                                     file.string(), grey.cols, grey.rows, camera.geometry.width_px,
                                     camera.geometry.height_px));
    vision::TagDetector detector(vision::machine_camera_options({nominal.print()}));
    const auto snapshot =
        read_snapshot({.image = grey, .source = file.string()}, camera, nominal, tag_id, detector);
    if (!snapshot) throw InputError(fmt::format("{}: {}", file.string(), snapshot.error().text));
    return {grey, snapshot->image.axis_mm, false};
}

}  // namespace fidservo::inspect
