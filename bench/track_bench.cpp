// SPDX-License-Identifier: GPL-3.0-or-later
// A tag followed from frame to frame on the machine's camera (1280 x 960, one tag of 300 px wholly in view,
// the stage 10 um further in every frame, the prediction 3 um off), beside libapriltag on the same frames in
// the same run. Core time of single frames, ms: median, p99, worst.
#include "bench/frame_times.h"
#include "plant/view/plate_view.h"
#include "tests/core_time.h"
#include "tests/reference_camera.h"
#include "tests/row_of_tags.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_tracker.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

using namespace fidservo;

constexpr int distinct_frames = 32;
constexpr int tag_id = 20;
constexpr double first_s_mm = 39.84, step_mm = 0.010, prediction_error_mm = 0.003;

double s_mm(int frame) {
    return first_s_mm + step_mm * frame;
}

const std::vector<cv::Mat>& frames() {
    static const std::vector<cv::Mat> rendered = [] {
        const plant::PlateView view(reference_camera(), row_of_tags(), {});
        std::vector<cv::Mat> images;
        images.reserve(distinct_frames);
        for (int k = 0; k < distinct_frames; ++k) images.push_back(view.render(std::array{s_mm(k)}, k));
        return images;
    }();
    return rendered;
}

vision::ExpectedTag expected(int frame, double error_mm) {
    const PlateTag tag = vision::find_tag(row_of_tags(), tag_id).value();
    vision::ExpectedTag place{tag_id, {}, 15.0};
    for (std::size_t c = 0; c < 4; ++c)
        place.corners_px[c] =
            project(reference_camera().geometry, vision::corners_mm(tag)[c], s_mm(frame) + error_mm);
    return place;
}

/// Times work(frame number) frame by frame.
template <class Work>
void run(benchmark::State& state, Work work) {
    (void)frames();
    std::vector<double> times_ms;
    int next = 0;
    for (auto _ : state) {
        const double begin_s = core_time_s();
        work(next++ % distinct_frames);
        const double took_s = core_time_s() - begin_s;
        state.SetIterationTime(took_s);
        times_ms.push_back(1000 * took_s);
    }
    bench::report_times(state, times_ms);
}

void demand(bool condition) {
    if (!condition) throw std::runtime_error("the tag was not found as it should be");
}

void library(benchmark::State& state) {
    vision::TagDetectorOptions options;
    options.min_contrast = static_cast<int>(state.range(0));
    options.decimation = static_cast<double>(state.range(1));
    vision::TagDetector detector(options);
    run(state, [&](int k) {
        const auto found = detector.detect(frames()[k], 0);
        demand(std::any_of(found.begin(), found.end(),
                           [](const TagDetection& tag) { return tag.tag_id == tag_id; }));
    });
}

void alignment_alone(benchmark::State& state) {
    run(state, [&](int k) { demand(vision::align_tag(frames()[k], 0, expected(k, 0.04)).has_value()); });
}

void refinement_alone(benchmark::State& state) {
    std::vector<TagDetection> tags;
    tags.reserve(distinct_frames);
    for (int k = 0; k < distinct_frames; ++k)
        tags.push_back(vision::align_tag(frames()[k], 0, expected(k, 0.0)).value());
    run(state, [&](int k) { demand(vision::refine_tag(frames()[k], tags[k]).has_value()); });
}

/// Alignment, reading of the code and refinement.
void tracked_frame(benchmark::State& state) {
    vision::TagTrackerOptions options;
    if (state.range(0) != 0) {
        options.refinement.camera = reference_camera().geometry;
        options.refinement.noise = vision::grey_noise(reference_camera());
    }
    vision::TagTracker tracker(options);
    const double px_per_mm = 1.0 / mm_per_px(reference_camera().geometry);
    (void)tracker.track(frames()[distinct_frames - 1], 0);
    int before = distinct_frames - 1;
    run(state, [&](int k) {
        const double moved_mm = s_mm(k) - s_mm(before) + prediction_error_mm;
        const auto tags =
            tracker.track(frames()[k], k, vision::PictureMotion{{-moved_mm * px_per_mm, 0}, 10.0});
        before = k;
        demand(std::any_of(tags.begin(), tags.end(), [](const vision::TrackedTag& tag) {
            return tag.tag.detection.tag_id == tag_id && tag.found_by == vision::FoundBy::tracking &&
                   tag.tag.explained > 0.9;
        }));
    });
    state.counters["tags"] = static_cast<double>(tracker.track(frames()[before], 0).size());
}

void lost_frame_in_region(benchmark::State& state) {
    vision::TagDetector detector;
    run(state, [&](int k) { demand(!detector.detect(frames()[k], 0, {400, 240, 480, 480}).empty()); });
}

constexpr double min_time_s = 1.0;
BENCHMARK(library)
    ->ArgNames({"min_contrast", "decimation"})
    ->Args({30, 1})
    ->Args({30, 2})
    ->Args({5, 2})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(min_time_s);
BENCHMARK(lost_frame_in_region)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(alignment_alone)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(refinement_alone)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(tracked_frame)
    ->ArgName("calibrated")
    ->Arg(0)
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(min_time_s);

}  // namespace

BENCHMARK_MAIN();
