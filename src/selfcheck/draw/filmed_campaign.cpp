// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/filmed_campaign.h"

#include "core/input_error.h"
#include "core/parallel.h"
#include "core/rig.h"
#include "reference/tag_picture.h"
#include "src/simulation/run_experiment.h"
#include "src/simulation/simulate_reference.h"
#include "vision/tags/tag_appearance.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

constexpr double filmed_s = 2.0, first_frame_s = 3.3e-3;

/// An experiment, and when filming begins: half a second before something new is commanded.
struct FilmedRun {
    const char* kind;
    double from_s;
};
constexpr std::array runs{FilmedRun{"micro-steps", 2.7},  FilmedRun{"micro-steps", 2.7},
                          FilmedRun{"micro-steps", 2.7},  FilmedRun{"micro-servo", 2.5},
                          FilmedRun{"micro-servo", 2.5},  FilmedRun{"micro-servo", 2.5},
                          FilmedRun{"macro-square", 1.5}, FilmedRun{"macro-square", 1.5}};

/// Straight between ticks; as at the ends beyond them.
double place_mm(const std::vector<double>& way_mm, double tick_s, double time_s) {
    const double at = std::clamp(time_s / tick_s, 0.0, static_cast<double>(way_mm.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(at), way_mm.size() - 2);
    return std::lerp(way_mm[k], way_mm[k + 1], at - static_cast<double>(k));
}

/// Detections that the frames of a way show, and their looks.
void film(Recording& recording, const reference::PictureModel& model, const std::vector<double>& way_mm,
          double from_s, std::uint64_t seed) {
    recording.detections.clear();
    vision::TagDetector detector;
    NoiseStream noise(seed, "reference/frames");
    const cv::Mat gains = pixel_gains(model, seed);
    const vision::RefinementOptions options{.camera = std::nullopt,
                                            .noise = vision::grey_noise(model.camera)};
    const double end_s = static_cast<double>(way_mm.size() - 1) * recording.tick_s;
    for (int frame = 0;; ++frame) {
        const double time_s = first_frame_s + frame / model.camera.frame_rate_hz;
        if (time_s > end_s) break;
        if (time_s < from_s) continue;
        const auto s_mm = [&](double after_s) {
            return place_mm(way_mm, recording.tick_s, time_s + after_s);
        };
        const reference::Picture picture = picture_of(model, s_mm, gains, noise);
        for (const TagDetection& tag :
             detector.detect(picture.image, nanoseconds(time_s), picture.region_px)) {
            const auto refined = vision::refine_tag(picture.image, tag, options);
            recording.detections.push_back(refined ? refined->detection : tag);
            recording.appearances.push_back(
                vision::tag_appearance(picture.image, recording.detections.back()));
        }
    }
}

}  // namespace

std::vector<Recording> film_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed) {
    const CameraGeometry& camera = nominal.camera->geometry;
    if (camera.rotation_rad != 0.0 || !camera.tilt_rad.isZero(0.0))
        throw InputError("--self-check: cases with frames need a camera that looks straight down");
    const reference::PictureModel model{*true_rig.rig.camera, *true_rig.rig.fiducials,
                                        true_rig.departures.image, reference::usual_cells};
    std::vector<Recording> recordings(runs.size());
    parallel_for(runs.size(), [&](std::size_t k) {
        const auto [kind, from_s] = runs[k];
        const std::string name = fmt::format("{}-{}", kind, k + 1);
        Experiment experiment = make_experiment(kind, nominal, seed, name);
        experiment.duration_s = from_s + filmed_s;
        std::vector<double> way_mm;
        recordings[k] =
            simulate_reference(true_rig.rig, true_rig.departures, experiment, name, seed, &way_mm);
        film(recordings[k], model, way_mm, from_s, noise_seed(name, seed));
    });
    return recordings;
}

}  // namespace fidservo::selfcheck
