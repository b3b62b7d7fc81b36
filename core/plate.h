// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The plate: fiducials and printed features at known places. Lengths in mm, plate frame (x along the stage
// axis, y down in the image). Angles in rad, from x towards y.
#include "core/tag_families.h"

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace fidservo {

/// A tag on the plate.
struct PlateTag {
    int id;                     ///< as its family's code book numbers it
    Eigen::Vector2d centre_mm;  ///< its place
    double side_mm;  ///< of the outline: the black border square, for families that have a plain border
    double angle_rad = 0.0;  ///< rotation from plate x towards y
    TagPrint print = {};     ///< how it is printed

    bool operator==(const PlateTag&) const = default;
};

/// A printed disc.
struct Dot {
    Eigen::Vector2d centre_mm;  ///< its place
    double diameter_mm;         ///< its size
};

/// A printed rectangle.
struct Pad {
    Eigen::Vector2d centre_mm;  ///< its place
    Eigen::Vector2d size_mm;    ///< width along its own x, height along its own y
    double angle_rad = 0.0;     ///< rotation from plate x towards y
};

/// A printed straight stroke.
struct Line {
    Eigen::Vector2d from_mm;  ///< middle of one end
    Eigen::Vector2d to_mm;    ///< middle of the other end
    double width_mm;          ///< its thickness
};

/// A scratch along a polyline, darker or brighter than what it crosses.
struct Scratch {
    std::vector<Eigen::Vector2d> points_mm;  ///< its corners, in order
    double width_mm;                         ///< its thickness
};

/// Something printed, or damaged.
struct Feature {
    std::string name;                             ///< as recipes and results call it
    std::variant<Dot, Pad, Line, Scratch> shape;  ///< what it is, and where
    double reflectance;                           ///< 0 black .. 1 white
};

/// What lies under the camera.
struct Plate {
    double paper_reflectance = 0.9;  ///< reflectance of the blank paper, 0 black .. 1 white
    double ink_reflectance = 0.1;    ///< reflectance of the tags' ink, 0 black .. 1 white
    std::vector<PlateTag> tags;      ///< all printed alike
    std::vector<Feature> features;   ///< later ones lie over earlier ones

    /// How all its tags are printed.
    TagPrint print() const { return tags.empty() ? TagPrint{} : tags.front().print; }
};

}  // namespace fidservo
