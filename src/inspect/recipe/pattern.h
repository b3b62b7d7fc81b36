// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is printed beside every site's fiducial, written once in the recipe.
#include "src/files/text/yaml_reader.h"
#include "src/inspect/recipe/recipe.h"

#include <string>
#include <vector>

namespace fidservo::inspect {

/// The shape moved on the plate.
Feature moved(Feature feature, const Eigen::Vector2d& by_mm);

/// The name of a pattern's feature on the plate: "dot" beside fiducial 12 is "dot@12".
std::string name_at(const std::string& feature, int tag_id);

/// Adds the features of a recipe's `pattern`, places counted from the fiducial, beside each of the fiducials.
void add_pattern(const YamlValue& list, const std::vector<int>& tag_ids, Plate& plate);

/// The view with its features' names resolved for one site: a pattern's feature where there is one, otherwise
/// the plate's feature of that name. "fiducial" stays.
View of_site(const View& view, const Plate& plate, int tag_id);

}  // namespace fidservo::inspect
