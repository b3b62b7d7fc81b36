// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recipe of an inspection: the nominal plate, the sites to visit, and the checks to make there.
// docs/inspection.md describes the file.
#include "core/plate.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// Check of a fiducial's place relative to the neighbouring fiducials of the nominal grid.
struct PlacementCheck {
    double tolerance_um;
};

/// Centre and size of a dot or a pad.
struct MarkCheck {
    std::string feature;
    double centre_tolerance_um;  ///< for x and for y, relative to the site's fiducial
    double size_tolerance_um;    ///< for the diameter, or for width and height
    double search_um;            ///< largest distance of the mark from its nominal place at which it is found
};

/// Width of a line: its mean and its narrowest place.
struct LineCheck {
    std::string feature;
    double width_tolerance_um;
    double search_um;
};

/// The gap between the edges of two features that face each other. "fiducial" stands for the site's own.
struct EdgeDistanceCheck {
    std::string feature_a, feature_b;
    double tolerance_um;
    double search_um;
};

/// Comparison with a reference image.
struct ReferenceCheck {
    /// Image of a good part; empty: the nominal plate is rendered.
    std::optional<std::filesystem::path> image;
    double longest_defect_um;  ///< defects up to this length are allowed
};

using Check = std::variant<PlacementCheck, MarkCheck, LineCheck, EdgeDistanceCheck, ReferenceCheck>;

struct View {
    std::string name;
    double offset_um;  ///< offset of the camera's axis from the site's fiducial, along the stage axis
    std::vector<Check> checks;
};

/// What happens when a site cannot be measured.
struct OnFailure {
    int retries = 1;     ///< number of immediate retries; after that:
    bool defer = false;  ///< visit it once more after all other sites; false: skip it
};

struct Site {
    int tag_id;  ///< id of its fiducial, which is also the site's name
    Eigen::Vector2d fiducial_mm;
    OnFailure on_failure;
    std::vector<View> views;
};

/// Data for the simulated rig only.
struct Simulation {
    std::optional<std::filesystem::path> plate;  ///< the plate as it was printed; empty: the nominal one
    std::uint64_t seed = 1;
};

struct Recipe {
    std::string name;
    std::filesystem::path file;
    Plate nominal;
    std::vector<Site> sites;  ///< in the order of visits
    Simulation simulation;
    double camera_reconnect_s = 0.0;  ///< how long to wait for a camera that is lost; 0: the run ends
};

/// Reads a recipe and checks it against the rig. Throws InputError for what is wrong in the file, and for
/// sites and views that this rig cannot reach or see.
Recipe load_recipe(const std::filesystem::path& file, const Rig& rig);

/// The same from text; `file` appears in messages and is where relative paths start.
Recipe parse_recipe(const std::string& text, const std::filesystem::path& file, const Rig& rig);

/// A feature of the nominal plate by name; empty if there is none.
const Feature* find_feature(const Plate& plate, const std::string& name);
/// A fiducial of the nominal plate by id; empty if there is none.
const PlateTag* find_tag(const Plate& plate, int id);

}  // namespace fidservo::inspect
