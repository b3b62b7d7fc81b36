// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What Evidence holds: every recording, prepared for all links of the signal chain (gap/links).
#include "core/rig.h"
#include "gap/evidence.h"
#include "gap/evidence/clear_detections.h"
#include "gap/evidence/hall_range.h"
#include "gap/evidence/late_ticks.h"
#include "gap/links/carriage_link.h"
#include "gap/links/controller_link.h"
#include "gap/links/hall_smoothing.h"
#include "gap/links/image_link.h"
#include "gap/links/platform_link.h"
#include "gap/links/power_on.h"
#include "gap/links/shutter.h"
#include "gap/links/tag_link.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// One recording, prepared for the links.
struct RunLinks {
    CarriageRun carriage;
    std::optional<PlatformRun> platform;      ///< empty without a micro stage
    std::optional<SmoothedReading> smoothed;  ///< the Hall reading, smoothed; empty without a micro stage
    TagRun tags;
    ControllerRun macro, micro;
    CarriagePath path;  ///< of the carriage, by the rig file's model
};

struct CarriagePaths {
    Hypothesis moving;                ///< the settings that move the carriage
    std::vector<CarriagePath> along;  ///< the path in each recording
};

struct Evidence::Parts {
    Rig rig;
    std::shared_ptr<const Budget> budget;
    std::vector<Recording> recordings;
    std::vector<LateTicks> late;     ///< for each recording
    std::vector<PlacesFrom> places;  ///< for each recording
    std::vector<RunLinks> links;
    std::vector<ImageRun> images;       ///< for each recording
    std::vector<TagsInFrames> smeared;  ///< for each recording
    Shutter shutter{0.0, 0.0};
    std::vector<Window> windows;
    /// For each run, index of its first window; then the number of windows.
    std::vector<std::size_t> first_window;
    std::size_t values = 0;
    std::array<double, signal_count> floors{};
    HallRange hall_range;
    std::vector<Omission> omissions;
    std::vector<Course> courses;
    Errors nominal;  ///< errors without any effects beyond the rig file
};

/// Throws InputError where a recording cannot be of this rig.
void check(const Rig& rig, const Recording& recording);

/// Estimates the noise of all sensors from all recordings, and sets the floors by it.
void find_noise(Evidence::Parts& parts);

/// Evaluates the appearance of the tags in all recordings, and estimates the camera's exposure and readout
/// times from it.
void find_looks(Evidence::Parts& parts);

/// Prepares the Hall readings of all recordings, and determines what is known of the wire's initial state in
/// each.
void find_wires(Evidence::Parts& parts);

/// Prepares the other links of a recording, lists its windows, and notes what is left out.
void add_run(Evidence::Parts& parts, std::size_t run);

}  // namespace fidservo::gap
