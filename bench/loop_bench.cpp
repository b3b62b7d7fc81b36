// SPDX-License-Identifier: GPL-3.0-or-later
// How punctual the control loop is while vision runs: lateness of its ticks at 1 kHz (median, 99 %, worst)
// beside that of cyclictest, which does nothing else, at the same priority on the same machine. Both run for
// FIDSERVO_LOOP_BENCH_S seconds (20).
#include "control/stage_loop.h"
#include "core/rig.h"
#include "plant/view/plate_view.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/session/sight.h"
#include "src/session/simulated_rig.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

namespace {

using namespace fidservo;

double duration_s() {
    const char* const given = std::getenv("FIDSERVO_LOOP_BENCH_S");
    return given != nullptr ? std::atof(given) : 20.0;
}

const Rig& reference_rig() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

/// Looks at one frame after the other, as a session does while the loop goes on.
class Vision {
  public:
    Vision() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
    std::uint64_t frames() const { return frames_; }

  private:
    void run(const std::stop_token& stop) {
        const Rig& rig = reference_rig();
        const Plate plate = plate_of(rig.fiducials.value());
        const plant::PlateView view(*rig.camera, plate, {});
        vision::Frame frame;
        frame.image = view.render(std::array{20.1}, 0);
        Sight sight(*rig.camera, plate);
        while (!stop.stop_requested()) {
            benchmark::DoNotOptimize(sight.locate_anywhere(frame));
            ++frames_;
        }
    }

    std::atomic<std::uint64_t> frames_{0};
    std::jthread thread_;
};

void report(benchmark::State& state, const control::LatenessHistogram& late, std::uint64_t overruns) {
    state.counters["ticks"] = static_cast<double>(late.total());
    state.counters["median_us"] = 1e-3 * static_cast<double>(late.quantile_ns(0.5));
    state.counters["p99_us"] = 1e-3 * static_cast<double>(late.quantile_ns(0.99));
    state.counters["worst_us"] = 1e-3 * static_cast<double>(late.worst_ns);
    state.counters["overruns"] = static_cast<double>(overruns);
}

/// The simulated stage under a watchdog, its samples taken from the ring as a session takes them.
void stage_loop(benchmark::State& state, bool with_vision) {
    const Rig& rig = reference_rig();
    for (auto _ : state) {
        const auto simulated = std::make_shared<SimulatedRig>(plant::plant_parameters(rig), *rig.camera,
                                                              plate_of(*rig.fiducials), 1);
        control::LoopOptions options;
        options.watchdog = control::watchdog_params(rig);
        options.watchdog->late_ticks = 1'000'000;  // lateness is what is measured
        control::StageLoop loop(std::make_shared<SimulatedStage>(simulated, nullptr), options);
        std::unique_ptr<Vision> vision = with_vision ? std::make_unique<Vision>() : nullptr;
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(duration_s());
        while (std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            while (loop.next()) {
            }
        }
        const control::LoopStatistics statistics = loop.statistics();
        if (vision) state.counters["frames"] = static_cast<double>(vision->frames());
        report(state, statistics.lateness, statistics.overruns);
        state.SetLabel(statistics.real_time_priority ? "SCHED_FIFO" : "SCHED_FIFO not permitted");
        if (const auto why = loop.ended()) state.SkipWithError(why->text.c_str());
    }
}

void cyclictest(benchmark::State& state, bool with_vision) {
    for (auto _ : state) {
        std::unique_ptr<Vision> vision = with_vision ? std::make_unique<Vision>() : nullptr;
        const std::string command = fmt::format(
            "cyclictest --quiet --mlockall --threads=1 --priority=1 --interval=1000 "
            "--histogram=1000000 --loops={:.0f} 2>/dev/null",
            1e3 * duration_s());
        std::FILE* const output = ::popen(command.c_str(), "r");
        control::LatenessHistogram late;
        char line[256];
        while (output != nullptr && std::fgets(line, sizeof line, output) != nullptr) {
            long us = 0;
            unsigned long count = 0;
            if (std::sscanf(line, "%ld %lu", &us, &count) != 2 || count == 0) continue;
            late.counts[control::LatenessHistogram::bin_of(1000 * us)] += count;
            late.worst_ns = 1000 * (us + 1);
        }
        if (output == nullptr || ::pclose(output) != 0 || late.total() == 0) {
            state.SkipWithError("cyclictest is not there or may not run (Debian package rt-tests)");
            return;
        }
        report(state, late, 0);
    }
}

}  // namespace

BENCHMARK_CAPTURE(stage_loop, alone, false)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(cyclictest, alone, false)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(stage_loop, beside_vision, true)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(cyclictest, beside_vision, true)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

BENCHMARK_MAIN();
