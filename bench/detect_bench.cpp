// SPDX-License-Identifier: GPL-3.0-or-later
// Detection and refinement of one frame of the machine's camera (1280 x 960, one tag of 300 px in view), with
// libapriltag as it comes beside it. Median, p99 and worst of single frames, ms.
#include "bench/frame_times.h"
#include "plant/view/plate_view.h"
#include "tests/reference_camera.h"
#include "tests/row_of_tags.h"
#include "vision/camera_position.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

using namespace fidservo;

constexpr int distinct_frames = 16;

/// Frames near tag 20, at many phases of the pixel grid; the tag alone is wholly in view.
const std::vector<cv::Mat>& frames() {
    static const std::vector<cv::Mat> rendered = [] {
        const plant::PlateView view(reference_camera(), row_of_tags(), {});
        std::vector<cv::Mat> images;
        images.reserve(distinct_frames);
        for (int k = 0; k < distinct_frames; ++k)
            images.push_back(view.render(std::array<double, 1>{40.0 + 0.00937 * k}, k));
        return images;
    }();
    return rendered;
}

/// Times every frame on its own.
template <class Work>
void run(benchmark::State& state, Work work) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> times_ms;
    std::size_t next = 0;
    for (auto _ : state) {
        const cv::Mat& image = frames()[next++ % distinct_frames];
        const auto begin = Clock::now();
        work(image);
        const std::chrono::duration<double> took = Clock::now() - begin;
        state.SetIterationTime(took.count());
        times_ms.push_back(1000 * took.count());
    }
    bench::report_times(state, times_ms);
}

void find(vision::TagDetector& detector, const cv::Mat& image, const cv::Rect& region = {}) {
    const auto found = detector.detect(image, 0, region);
    if (std::none_of(found.begin(), found.end(), [](const TagDetection& tag) { return tag.tag_id == 20; }))
        throw std::runtime_error("the tag was not found");
}

void BM_MachineCamera(benchmark::State& state) {
    vision::TagDetector detector(vision::machine_camera_options());
    run(state, [&](const cv::Mat& image) { find(detector, image); });
}

/// The tag's place is known to a tag's cell: region of 400 x 400 px.
void BM_MachineCameraInRegion(benchmark::State& state) {
    vision::TagDetector detector(vision::machine_camera_options());
    run(state, [&](const cv::Mat& image) { find(detector, image, {420, 280, 440, 400}); });
}

void BM_LibraryDefaultsAtFullResolution(benchmark::State& state) {
    vision::TagDetectorOptions defaults;
    defaults.min_contrast = 5;
    vision::TagDetector detector(defaults);
    run(state, [&](const cv::Mat& image) { find(detector, image); });
}

void BM_LibraryDefaultsDecimatedByTwo(benchmark::State& state) {
    vision::TagDetectorOptions defaults;
    defaults.min_contrast = 5;
    defaults.decimation = 2.0;
    vision::TagDetector detector(defaults);
    run(state, [&](const cv::Mat& image) { find(detector, image); });
}

void BM_Thorough(benchmark::State& state) {
    vision::TagDetector detector(vision::thorough_options());
    run(state, [&](const cv::Mat& image) { find(detector, image); });
}

void BM_RefinementAlone(benchmark::State& state) {
    std::vector<TagDetection> tags;
    vision::TagDetector detector;
    for (const cv::Mat& image : frames())
        for (const TagDetection& tag : detector.detect(image, 0))
            if (tag.tag_id == 20) tags.push_back(tag);
    std::size_t next = 0;
    run(state, [&](const cv::Mat& image) {
        const auto refined = vision::refine_tag(image, tags[next++ % distinct_frames]);
        if (!refined) throw std::runtime_error(refined.error().text);
    });
}

/// From the frame to the camera's position with its standard deviation: all that the loop does per frame.
void BM_FrameToPosition(benchmark::State& state) {
    const Plate plate = row_of_tags();
    vision::TagDetector detector;
    run(state, [&](const cv::Mat& image) {
        const vision::Frame frame{image, 0, 0, 0, ""};
        const auto fit =
            vision::locate_camera(reference_camera().geometry, plate, frame, detector.detect(image, 0), 20);
        if (!fit) throw std::runtime_error(fit.error().text);
    });
}

constexpr double min_time_s = 1.0;
BENCHMARK(BM_MachineCamera)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(BM_MachineCameraInRegion)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(BM_LibraryDefaultsAtFullResolution)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(min_time_s);
BENCHMARK(BM_LibraryDefaultsDecimatedByTwo)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(min_time_s);
BENCHMARK(BM_Thorough)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(BM_RefinementAlone)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);
BENCHMARK(BM_FrameToPosition)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(min_time_s);

}  // namespace

BENCHMARK_MAIN();
