// SPDX-License-Identifier: GPL-3.0-or-later
// Frames a second of the simulated camera, on one core, beside what a run in real time and more asks for.
#include "bench/frame_times.h"
#include "core/camera/camera_parameters.h"
#include "plant/view/plate_view.h"
#include "tests/core_time.h"
#include "tests/reference_camera.h"

#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace fidservo::plant {
namespace {

constexpr double limit_frames_per_s = 200.0;

Plate one_tag() {
    Plate plate;
    plate.tags.push_back({.id = 0, .centre_mm = {0.0, 0.0}, .side_mm = 1.2, .angle_rad = 0.012});
    return plate;
}

/// One tag among dots, pads, lines and scratches, all in view.
Plate one_tag_and_twelve_features() {
    Plate plate = one_tag();
    for (int k = 0; k < 4; ++k) {
        const double x = -1.5 + k, y = 1.0;
        plate.features.push_back({"dot", Dot{{x, y}, 0.3}, 0.1});
        plate.features.push_back({"pad", Pad{{x, y + 0.5}, {0.5, 0.3}, 0.1 * k}, 0.1});
        plate.features.push_back({"line", Line{{x - 0.4, -1.2}, {x + 0.4, -1.1}, 0.05}, 0.1});
    }
    plate.features.back().shape = Scratch{{{-0.5, 0.8}, {0.1, 1.0}, {0.4, 1.4}}, 0.02};
    return plate;
}

CameraParameters straight_camera() {
    return reference_camera();
}

CameraParameters turned_camera() {
    CameraParameters camera = reference_camera();
    camera.geometry.rotation_rad = 0.0122;
    return camera;
}

/// Turned, tilted and distorting.
CameraParameters warping_camera() {
    CameraParameters camera = turned_camera();
    camera.geometry.tilt_rad = {0.035, -0.039};
    camera.geometry.distortion.k1 = -0.2;
    return camera;
}

/// Renders one frame an iteration, the camera at speed_mm_per_s.
void render(benchmark::State& state, const Plate& plate, double speed_mm_per_s,
            const CameraParameters& camera = straight_camera()) {
    const PlateView view(camera, plate, {});
    std::vector<double> s_mm(speed_mm_per_s == 0.0 ? 1 : 9);
    std::vector<double> times_ms;
    std::uint64_t frame = 0;
    for (auto _ : state) {
        const double start_mm = 0.3 * std::sin(0.1 * static_cast<double>(frame));
        for (std::size_t k = 0; k < s_mm.size(); ++k) {
            s_mm[k] = start_mm + speed_mm_per_s * camera.exposure_s * static_cast<double>(k) / 8.0;
        }
        const double begin_s = core_time_s();
        cv::Mat image = view.render(s_mm, frame++);
        benchmark::DoNotOptimize(image.data);
        times_ms.push_back(1e3 * (core_time_s() - begin_s));
    }
    state.counters["frames_per_s"] = 1000.0 / bench::quantile(times_ms, 0.5);
    state.counters["limit_frames_per_s"] = limit_frames_per_s;
    bench::report_times(state, times_ms);
}

BENCHMARK_CAPTURE(render, one_tag_at_rest, one_tag(), 0.0)->Unit(benchmark::kMillisecond)->MinTime(2.0);
BENCHMARK_CAPTURE(render, one_tag_at_10_mm_per_s, one_tag(), 10.0)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, one_tag_at_300_mm_per_s, one_tag(), 300.0)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, one_tag_and_twelve_features, one_tag_and_twelve_features(), 0.0)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);

BENCHMARK_CAPTURE(render, turned_camera_at_rest, one_tag(), 0.0, turned_camera())
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, turned_camera_at_10_mm_per_s, one_tag(), 10.0, turned_camera())
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, warping_camera_at_rest, one_tag(), 0.0, warping_camera())
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, warping_camera_at_10_mm_per_s, one_tag(), 10.0, warping_camera())
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(render, warping_camera_one_tag_and_twelve_features, one_tag_and_twelve_features(), 0.0,
                  warping_camera())
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);

}  // namespace
}  // namespace fidservo::plant

BENCHMARK_MAIN();
