// SPDX-License-Identifier: GPL-3.0-or-later
// How long a hypothesis takes on a whole practice campaign: what a search does some hundred times.
#include "core/rig.h"
#include "gap/evidence.h"
#include "plant/effects/catalogue.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

namespace fidservo {

namespace {

using namespace gap;

const Evidence& campaign() {
    static const Evidence evidence = [] {
        std::vector<Recording> recordings;
        for (const auto& folder :
             find_recordings(std::filesystem::path(FIDSERVO_DATA_DIR) / "campaigns" / "no-effect"))
            recordings.push_back(read_recording(folder));
        return Evidence(load_rig(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml"), recordings);
    }();
    return evidence;
}

void predict(benchmark::State& state, const std::string& effects, Signal signal) {
    if (!std::filesystem::is_directory(std::filesystem::path(FIDSERVO_DATA_DIR) / "campaigns")) {
        state.SkipWithError("the shared data are absent");
        return;
    }
    Wanted wanted = everything(campaign());
    for (std::size_t w = 0; w < wanted.size(); ++w)
        wanted[w] = campaign().windows()[w].signal == signal ? 1 : 0;
    Hypothesis hypothesis;
    for (std::size_t at = 0; at <= effects.size();) {
        const std::size_t end = std::min(effects.find('+', at), effects.size());
        hypothesis.push_back(plant::parse_effect(effects.substr(at, end - at)));
        at = end + 1;
    }
    const double before = campaign().effort();
    for (auto _ : state) benchmark::DoNotOptimize(campaign().errors(hypothesis, wanted));
    // What a search counts of it: as many a second whatever is predicted, if it counts rightly.
    state.counters["effort/s"] =
        benchmark::Counter(campaign().effort() - before, benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(predict, encoder_drive_gain, "drive_gain:factor=1.02", Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_drive_delay, "drive_delay:delay_ms=3", Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_stribeck, "stribeck_friction", Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_stribeck_creeping, "stribeck_friction:creep_mm_per_s=0.37",
                  Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_cogging, "cogging", Signal::encoder)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_cogging_with_harmonic, "cogging:second_sine=0.2", Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_cable, "cable_force:hardening=0.3", Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_ripple, "encoder_ripple", Signal::encoder)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_belt, "belt_compliance", Signal::encoder)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_belt_creeping, "belt_compliance+stribeck_friction:creep_mm_per_s=0.37",
                  Signal::encoder)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, encoder_bristles, "presliding", Signal::encoder)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, hall_airflow, "airflow:factor=0.8", Signal::hall)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, hall_coupling, "macro_coupling", Signal::hall)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, tag_pixel_scale, "pixel_scale", Signal::tag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, tag_tilt, "camera_tilt", Signal::tag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, tag_hall_gain, "hall_gain", Signal::tag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, tag_encoder_ripple, "encoder_ripple", Signal::tag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(predict, tag_drive_gain, "drive_gain:factor=1.02", Signal::tag)
    ->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace fidservo

BENCHMARK_MAIN();
