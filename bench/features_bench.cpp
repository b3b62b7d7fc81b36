// SPDX-License-Identifier: GPL-3.0-or-later
// How long measuring takes, and how small a defect the comparison finds.
#include "core/camera/camera_parameters.h"
#include "core/random.h"
#include "plant/view/plate_view.h"
#include "tests/reference_camera.h"
#include "vision/features/line.h"
#include "vision/features/mark.h"
#include "vision/features/pad.h"
#include "vision/features/reference_compare.h"

#include <array>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

using namespace fidservo;
using namespace fidservo::vision;

constexpr double place_mm = 100.0;
const Dot dot{{99.0, 1.2}, 0.3};
const Pad pad{{99.8, 1.2}, {0.3, 0.2}};
const Line line{{100.4, 1.2}, {101.6, 1.2}, 0.06};

Plate good_plate() {
    Plate plate;
    for (int id = 49; id <= 51; ++id) plate.tags.push_back({id, {2.0 * id, 0.0}, 1.2});
    plate.features = {{"dot", dot, 0.1}, {"pad", pad, 0.1}, {"line", line, 0.1}};
    for (int k = 0; k < 5; ++k)
        plate.features.push_back({"row", Dot{{98.7 + 0.6 * k, -1.2}, 0.1 + 0.05 * k}, 0.1});
    return plate;
}

RestImage take(const Plate& plate, double s_mm, std::uint64_t seed, bool noise = true) {
    plant::ViewOptions options;
    options.seed = seed;
    options.noise = noise;
    if (!noise) options.light = {1.0, {0.0, 0.0}, 0.0};
    const CameraParameters camera = reference_camera();
    const std::array at_mm{s_mm};
    return {plant::PlateView(camera, plate, options).render(at_mm, 0), camera, {s_mm, 0.0}, {0.0, 0.0}};
}

template <class Measure>
void measure(benchmark::State& state, const Measure& feature) {
    const RestImage image = take(good_plate(), place_mm, 1);
    for (auto _ : state) {
        auto result = feature(image);
        if (!result) state.SkipWithError(result.error().text.c_str());
        benchmark::DoNotOptimize(result);
    }
}

void MeasureDot(benchmark::State& state) {
    measure(state, [](const RestImage& image) { return measure_dot(image, dot); });
}
void MeasurePad(benchmark::State& state) {
    measure(state, [](const RestImage& image) { return measure_pad(image, pad); });
}
void MeasureLine(benchmark::State& state) {
    measure(state, [](const RestImage& image) { return measure_line(image, line); });
}
BENCHMARK(MeasureDot)->Unit(benchmark::kMillisecond);
BENCHMARK(MeasurePad)->Unit(benchmark::kMillisecond);
BENCHMARK(MeasureLine)->Unit(benchmark::kMillisecond);

ReferenceImage drawn_reference() {
    const RestImage ideal = take(good_plate(), place_mm, 1, false);
    return {ideal.grey, ideal.axis_mm, true};
}

/// A full view that is as it should be: time, and false alarms per view.
void CompareGoodView(benchmark::State& state) {
    const ReferenceImage reference = drawn_reference();
    NoiseStream random(1, "good views");
    double views = 0.0;
    double alarmed = 0.0;
    for (auto _ : state) {
        state.PauseTiming();
        const RestImage image = take(good_plate(), place_mm + 0.1 * (random.uniform() - 0.5), random.bits());
        state.ResumeTiming();
        const auto comparison = compare_with_reference(image, reference);
        if (!comparison) state.SkipWithError(comparison.error().text.c_str());
        ++views;
        alarmed += comparison && !comparison->defects.empty();
    }
    state.counters["views"] = views;
    state.counters["false_alarms_per_view"] = alarmed / views;
}
BENCHMARK(CompareGoodView)->Unit(benchmark::kMillisecond)->Iterations(200);

/// Whether a defect is among those found, and nothing else.
bool only_this(const Comparison& comparison, const Eigen::Vector2d& at_mm) {
    constexpr double near_mm = 0.05;
    return comparison.defects.size() == 1 && (comparison.defects[0].centre_mm - at_mm).norm() < near_mm;
}

/// Detected part against size: a speck (reflectance 0.5 on paper of 0.9) of the given diameter in um.
void DetectSpeck(benchmark::State& state) {
    const ReferenceImage reference = drawn_reference();
    const double diameter_mm = static_cast<double>(state.range(0)) * 1e-3;
    NoiseStream random(2, "specks");
    double views = 0.0;
    double found = 0.0;
    for (auto _ : state) {
        Plate plate = good_plate();
        const Eigen::Vector2d at_mm(98.0 + 4.0 * random.uniform(), 0.8 + 0.15 * random.uniform());
        plate.features.push_back({"speck", Dot{at_mm, diameter_mm}, 0.5});
        const auto comparison = compare_with_reference(take(plate, place_mm, random.bits()), reference);
        ++views;
        found += comparison && only_this(*comparison, at_mm);
    }
    state.counters["found"] = found / views;
}
BENCHMARK(DetectSpeck)->DenseRange(2, 12, 1)->Arg(16)->Arg(20)->Unit(benchmark::kMillisecond)->Iterations(20);

/// Detected part against width: a scratch 0.3 mm long across bare paper, of the given width in um and of a
/// contrast of 10 % of the paper.
void DetectFaintScratch(benchmark::State& state) {
    const ReferenceImage reference = drawn_reference();
    const double width_mm = static_cast<double>(state.range(0)) * 1e-3;
    NoiseStream random(3, "scratches");
    double views = 0.0;
    double found = 0.0;
    for (auto _ : state) {
        Plate plate = good_plate();
        const Eigen::Vector2d at_mm(98.0 + 4.0 * random.uniform(), 0.8);
        const Eigen::Vector2d half_mm(0.14, 0.05 * (2.0 * random.uniform() - 1.0));
        plate.features.push_back({"scratch", Scratch{{at_mm - half_mm, at_mm + half_mm}, width_mm}, 0.81});
        const auto comparison = compare_with_reference(take(plate, place_mm, random.bits()), reference);
        ++views;
        found += comparison && only_this(*comparison, at_mm);
    }
    state.counters["found"] = found / views;
}
BENCHMARK(DetectFaintScratch)->DenseRange(2, 20, 3)->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace

BENCHMARK_MAIN();
