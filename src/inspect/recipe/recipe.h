// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an inspection is told: the plate as it should be, the places to go to, and what to check there.
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

/// The site's fiducial against the nominal grid: its place relative to the fiducials beside it.
struct PlacementCheck {
    double tolerance_um;
};

/// Centre and size of a dot or a pad.
struct MarkCheck {
    std::string feature;
    double centre_tolerance_um;  ///< in x and in y, relative to the site's fiducial
    double size_tolerance_um;    ///< of the diameter, or of width and height
    double search_um;            ///< the mark lies this far from its nominal place at most
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
    std::optional<std::filesystem::path> image;  ///< of a good part; empty: drawn from the nominal plate
    double longest_defect_um;                    ///< defects up to this length are allowed
};

using Check = std::variant<PlacementCheck, MarkCheck, LineCheck, EdgeDistanceCheck, ReferenceCheck>;

struct View {
    std::string name;
    double offset_um;  ///< of the camera's axis from the site's fiducial, along the stage axis
    std::vector<Check> checks;
};

/// What happens when a site cannot be measured.
struct OnFailure {
    int retries = 1;     ///< at once, that many times; then:
    bool defer = false;  ///< come back once, after all other sites; otherwise skip
};

struct Site {
    int tag_id;  ///< of its fiducial: also its name
    Eigen::Vector2d fiducial_mm;
    OnFailure on_failure;
    std::vector<View> views;
};

/// Only the simulated rig sees this.
struct Simulation {
    std::optional<std::filesystem::path> plate;  ///< as it was printed; empty: as it should be
    std::uint64_t seed = 1;
};

struct Recipe {
    std::string name;
    std::filesystem::path file;
    Plate nominal;
    std::vector<Site> sites;  ///< in the order in which they are visited
    Simulation simulation;
    double camera_reconnect_s = 0.0;  ///< a camera that is lost is waited for so long; 0: the run ends
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
