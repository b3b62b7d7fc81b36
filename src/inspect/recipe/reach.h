// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Checks of a recipe against the rig: sites and views that it cannot reach or see are refused when the recipe
// is read.
#include "core/camera/camera_geometry.h"
#include "src/files/text/yaml_reader.h"
#include "src/inspect/recipe/recipe.h"

namespace fidservo::inspect {

/// The stage has one axis: throws InputError at `where` if the fiducial's row never comes into view.
void check_fiducial_in_rows(const YamlValue& where, const Rig& rig, const PlateTag& tag);

/// Throws InputError at `where` if the camera cannot go to the view, or if the site's fiducial or a feature
/// to be measured lies outside the image there, or is not on the plate, or is not of a kind that can be
/// measured.
void check_view(const YamlValue& where, const Rig& rig, const Plate& plate, const Site& site,
                const View& view);

/// Throws InputError at `where` if a fiducial is to be placed and no other is seen beside it.
void check_placement(const YamlValue& where, const Rig& rig, const Plate& plate, const Site& site);

/// Whether a fiducial with its white margin lies wholly in the image.
bool tag_in_view(const CameraGeometry& camera, const PlateTag& tag, double s_mm);

}  // namespace fidservo::inspect
