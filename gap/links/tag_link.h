// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From encoder and Hall sensor to the tags in the image.
//
// The camera is at s(t) = y(t) + x(t): y the carriage's path (carriage_link.h), x the platform by the
// smoothed Hall reading (hall_smoothing.h), through the inverse of the hypothesis's sensors. A corner of a
// tag is seen at s of the time at which its row was exposed, through the hypothesis's camera.
//
// Where in its count the carriage stands, 12 px on the reference rig, the encoder does not say. The
// detections of the 100 ms before a window do: they give an offset of y, of at most a count, for the window,
// against the run that enters it; the later ones more, as how that run begins dies out.
//
// Where the encoder's zero is known by the tags alone (gap/links/power_on.h), each hypothesis finds anew what
// it is off by: with another camera, or another scale of the counts, the same detections say another zero.
//
// A detection has eight values. They are turned (a reflection) so that the first one lies along the motion of
// the stage in the image, u of all four corners; what is uncertain of s enters this one alone:
//
//     floor^2 = corner noise^2 + |d corners / ds|^2 (std of x ^2 + std of y ^2)
//
// The std of x is the smoothed reading's. That of y grows with the way since the window's 100 ms began, as a
// share of it, to what rounding hides; this is what it is, too, where no detection gave the offset.
//
// Where rows are exposed one after the other, s of one corner is wrong by another amount than s of the next:
// the other values' floors then hold what the smoothed reading's error changes by from the first of these
// times to the last one, and that share of the carriage's way between them.
#include "gap/evidence.h"
#include "gap/links/carriage_link.h"
#include "gap/links/hall_smoothing.h"
#include "plant/actual_camera.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

using CornerValues = Eigen::Matrix<double, corner_values, 1>;  ///< u and v of the corners in turn

/// A detection that is judged.
struct TagSighting {
    double stamp_s = 0.0;                                 ///< since the recording's first row
    Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();  ///< of its tag, on the plate
    std::array<Eigen::Vector2d, 4> corners_mm{centre_mm, centre_mm, centre_mm, centre_mm};  ///< likewise
    CornerValues corners_px = CornerValues::Zero();
    CornerValues mirror = CornerValues::Zero();     ///< normal of the reflection that turns the values
    CornerValues floors_px = CornerValues::Zero();  ///< of the turned values
    double offset_weight = 0.0;                     ///< in finding the offset, 1/px^2
    bool is_known = false;                          ///< the plate has this tag
};

struct TagWindow {
    WindowRows rows;
    std::size_t lead, first, end;  ///< detections: those before the window, those in it
};

struct TagRun {
    std::vector<double> time_s;  ///< of the rows, since the first
    std::vector<TagSighting> sightings;
    std::vector<TagWindow> windows;
    double tick_s = 0.0;
    bool is_seen = false;       ///< in a camera's images, which show the mean over their exposure
    bool zero_is_seen = false;  ///< what the encoder's zero is off by is found anew by each hypothesis
};

/// What makes detections uncertain: their corners' own noise, and what is seen of the readout.
struct TagNoise {
    double corner_px, readout_s;
};

/// @param path    of the rig file's carriage
/// @param reading empty for a rig without micro stage
TagRun tag_run(const Recording& recording, const Rig& rig, const CarriagePath& path,
               const CarriageRun& carriage, const PlatformRun* platform, const SmoothedReading* reading,
               const TagNoise& noise);

/// The camera and the sensors by which it is known where it is.
struct TagModel {
    CameraGeometry nominal;
    plant::ActualCamera camera;  ///< without formulas
    plant::CameraDeviation deviation;
    double exposure_s;
    double resolution_mm;
    std::optional<plant::MicroStageParameters> micro;
    double drive_gain;
};

/// Demands a camera.
TagModel tag_model(const plant::PlantParameters& parameters, const Rig& rig);

/// Values of a detection turned as its errors are.
CornerValues turned(const TagSighting& sighting, const CornerValues& values);

/// By how much the carriage is beside where its encoder's zero puts it, mm: the median over detections spread
/// evenly over the recording; 0 where the zero is known without them.
double zero_offset_mm(const TagModel& model, const TagRun& run, const CarriagePath& path,
                      const SmoothedReading* reading);

/// The turned values, prediction minus recording in px, of a window's detections one after the other.
/// @param zero_mm  zero_offset_mm()
std::vector<CornerValues> tag_errors(const TagModel& model, const TagRun& run, const TagWindow& window,
                                     const CarriagePath& path, const SmoothedReading* reading,
                                     double zero_mm);

}  // namespace fidservo::gap
