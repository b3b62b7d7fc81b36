// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The checks of a recipe, made on images taken at rest.
#include "src/inspect/measure/results.h"
#include "src/inspect/recipe/recipe.h"
#include "src/inspect/recipe/snapshot.h"
#include "vision/features/reference_compare.h"

#include <functional>
#include <vector>

namespace fidservo::inspect {

/// Renders the nominal plate as the camera would see it with its axis at a plate point, without noise.
using DrawNominal = std::function<vision::ReferenceImage(const Eigen::Vector2d& axis_mm)>;

/// The data for the checks of one view.
struct CheckContext {
    const Site& site;
    const View& view;
    const Plate& nominal;
    const Snapshot& snapshot;
    const std::vector<Snapshot>& snapshots;  ///< of all views of the site
    const DrawNominal& draw_nominal;
    std::string image;  ///< file name for the rows
};

struct CheckedView {
    std::vector<ResultRow> rows;
    std::vector<Overlay> overlays;
};

/// Makes all checks of a view, in the recipe's order. A failed measurement becomes a row with the reason:
/// `fail` for a feature that is not there, `not_decidable` for everything else.
CheckedView check_view(const CheckContext& context);

/// The rows of a view of which there is no image: one not_measured row for each check, with the reason.
std::vector<ResultRow> rows_not_measured(const Site& site, const View& view, const std::string& reason);

}  // namespace fidservo::inspect
