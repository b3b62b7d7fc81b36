// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From encoder and Hall sensor to the tags in the image.
//
// The camera's position is s(t) = y(t) + x(t): y is the carriage's path (gap/links/carriage_link.h), x the
// platform's position by the smoothed Hall reading (gap/links/hall_smoothing.h), through the inverse of the
// hypothesis's sensors. The hypothesis's camera sees a corner of a tag from its position s at the time at
// which the corner's row was exposed.
//
// The encoder does not determine the carriage's position within a count, which is 12 px on the reference rig.
// The tags detected in the 100 ms before a window do: they give an offset of y for the window, of at most a
// count, relative to the window's simulation, which begins with these 100 ms. Later detections have a larger
// weight, since an error of the simulation's start decays.
//
// Where the encoder's zero is known from the tags alone (gap/links/power_on.h), each hypothesis estimates the
// zero's error anew: with another camera, or another scale of the counts, the same detections give another
// zero.
//
// The eight values of a detection are reflected such that the first one lies along the stage's motion in the
// image (u of all four corners). The uncertainty of s enters this one alone:
//
//     floor^2 = corner noise^2 + |d corners / ds|^2 (std of x ^2 + std of y ^2)
//
// The std of x is that of the smoothed reading. The std of y grows in proportion to the distance covered
// since the start of the 100 ms before the window, up to that of a position within its count. If there was no
// detection for the offset, it has this largest value throughout.
//
// With a rolling shutter, which exposes rows one after the other, the error of s differs from corner to
// corner. The floors of the other seven values then contain the change of the smoothed reading's error from
// the exposure of the first corner to that of the last, and the growth of the std of y between these times.
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

/// Coordinates u and v of the first corner, of the second one, and so on.
using CornerValues = Eigen::Matrix<double, corner_values, 1>;

/// A detection that is judged.
struct TagSighting {
    double stamp_s = 0.0;                                 ///< time since the recording's first row
    Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();  ///< centre of its tag, on the plate
    /// Corners of its tag, on the plate.
    std::array<Eigen::Vector2d, corner_count> corners_mm{centre_mm, centre_mm, centre_mm, centre_mm};
    CornerValues corners_px = CornerValues::Zero();
    double slope_px_per_mm = 0.0;                   ///< |d corners / ds|
    CornerValues mirror = CornerValues::Zero();     ///< normal of the reflection
    CornerValues floors_px = CornerValues::Zero();  ///< floors of the reflected values
    double offset_weight = 0.0;                     ///< weight in the estimate of the offset, 1/px^2
    bool is_known = false;                          ///< the plate has this tag
};

struct TagWindow {
    WindowRows rows;
    /// First detection before the window; first detection in it, and the one after its last.
    std::size_t lead, first, end;
};

struct TagRun {
    std::vector<double> time_s;  ///< time of the rows since the first one
    std::vector<TagSighting> sightings;
    std::vector<TagWindow> windows;
    double tick_s = 0.0;
    bool is_seen = false;       ///< detected in a camera's images, which show the mean over their exposure
    bool zero_is_seen = false;  ///< each hypothesis estimates the error of the encoder's zero anew
};

/// What makes detections uncertain: the noise of a corner coordinate, and the readout time that was observed.
struct TagNoise {
    double corner_px, readout_s;
};

/// @param path    of the carriage, by the rig file's model
/// @param reading null for a rig without a micro stage
TagRun tag_run(const Recording& recording, const Rig& rig, const CarriagePath& path,
               const CarriageRun& carriage, const PlatformRun* platform, const SmoothedReading* reading,
               const TagNoise& noise);

/// The camera of a hypothesis, and the sensors from which its position follows.
struct TagModel {
    CameraGeometry nominal;
    plant::ActualCamera camera;  ///< its geometry, if that does not change with time or position
    plant::CameraDeviation deviation;
    double exposure_s;
    double resolution_mm;
    std::optional<plant::MicroStageParameters> micro;
    double drive_gain;
};

/// Requires a camera.
TagModel tag_model(const plant::PlantParameters& parameters, const Rig& rig);

/// The eight values of a detection, px, after the reflection that is described above.
CornerValues turned(const TagSighting& sighting, const CornerValues& values);

/// The error of the encoder's zero under a hypothesis, mm: the carriage's position by the tags minus that by
/// the encoder, as the median over detections that are spread evenly over the recording. 0 if the zero is
/// known without tags.
double zero_offset_mm(const TagModel& model, const TagRun& run, const CarriagePath& path,
                      const SmoothedReading* reading);

/// Prediction minus recording, in px, of the reflected values of a window's detections.
/// @param zero_mm  result of zero_offset_mm()
std::vector<CornerValues> tag_errors(const TagModel& model, const TagRun& run, const TagWindow& window,
                                     const CarriagePath& path, const SmoothedReading* reading,
                                     double zero_mm);

}  // namespace fidservo::gap
