// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What Evidence holds: every recording prepared for every stretch of the signal chain.
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

/// One recording.
struct RunLinks {
    CarriageRun carriage;
    std::optional<PlatformRun> platform;      ///< empty without micro stage
    std::optional<SmoothedReading> smoothed;  ///< likewise
    TagRun tags;
    ControllerRun macro, micro;
    CarriagePath path;  ///< of the rig file's carriage
};

struct CarriagePaths {
    Hypothesis moving;                ///< what of the hypothesis moves the carriage
    std::vector<CarriagePath> along;  ///< each recording
};

struct Evidence::Parts {
    Rig rig;
    std::shared_ptr<const Budget> budget;
    std::vector<Recording> recordings;
    std::vector<LateTicks> late;     ///< of each recording
    std::vector<PlacesFrom> places;  ///< of each recording
    std::vector<RunLinks> links;
    std::vector<ImageRun> images;       ///< of each recording
    std::vector<TagsInFrames> smeared;  ///< of each recording
    Shutter shutter{0.0, 0.0};
    std::vector<Window> windows;
    std::vector<std::size_t> first_window;  ///< of each run, and one past the last
    std::size_t values = 0;
    std::array<double, signal_count> floors{};
    HallRange hall_range;
    std::vector<Omission> omissions;
    std::vector<Course> courses;
    Errors nominal;  ///< without a hypothesis
};

/// Throws InputError where a recording cannot be of this rig.
void check(const Rig& rig, const Recording& recording);

/// Noise of all sensors, from all recordings: sets their floors.
void find_noise(Evidence::Parts& parts);

/// How tags look in all recordings, and what that says of the shutter.
void find_looks(Evidence::Parts& parts);

/// Prepares what all recordings say of the platform, and finds in which state each finds the wire.
void find_wires(Evidence::Parts& parts);

/// Prepares the rest of a recording, lists its windows, and notes what is left out.
void add_run(Evidence::Parts& parts, std::size_t run);

}  // namespace fidservo::gap
