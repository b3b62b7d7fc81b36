#pragma once
// The plate: fiducials and printed features at known places. Lengths in mm, plate frame (x along the stage
// axis, y down in the image). Angles in rad, from x towards y.
#include "core/tag_families.h"

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace fidservo {

struct PlateTag {
    int id;
    Eigen::Vector2d centre_mm;
    double side_mm;  ///< of the outline: the black border square, for families that have a plain border
    double angle_rad = 0.0;
    TagPrint print = {};

    bool operator==(const PlateTag&) const = default;
};

struct Dot {
    Eigen::Vector2d centre_mm;
    double diameter_mm;
};

struct Pad {
    Eigen::Vector2d centre_mm;
    Eigen::Vector2d size_mm;  ///< width along its own x, height along its own y
    double angle_rad = 0.0;
};

struct Line {
    Eigen::Vector2d from_mm;
    Eigen::Vector2d to_mm;
    double width_mm;
};

/// A polyline damage, darker or brighter than what it crosses.
struct Scratch {
    std::vector<Eigen::Vector2d> points_mm;
    double width_mm;
};

struct Feature {
    std::string name;
    std::variant<Dot, Pad, Line, Scratch> shape;
    double reflectance;  ///< 0 black .. 1 white
};

struct Plate {
    double paper_reflectance = 0.9;
    double ink_reflectance = 0.1;
    std::vector<PlateTag> tags;     ///< all printed alike
    std::vector<Feature> features;  ///< later ones lie over earlier ones

    /// Of all its tags.
    TagPrint print() const { return tags.empty() ? TagPrint{} : tags.front().print; }
};

}  // namespace fidservo
