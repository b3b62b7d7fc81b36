// SPDX-License-Identifier: GPL-3.0-or-later
// Replay on all cores, from the files to the tables, against the work itself on one: decode and detect, image
// by image. The demand is 85 % of  cores / (s per image to decode and detect on one core).
//
// Both run in turns, several rounds, on a machine that does nothing else:
//     of_ideal        = n t1 / (cores wall)         t1: core time per image, decode and detect alone
//     core_time_ratio = core time of replay / n t1
// Medians over the rounds, the worst round beside them.
#include "core/input_error.h"
#include "plant/view/plate_view.h"
#include "src/files/recording/writer.h"
#include "src/replay/replay.h"
#include "tests/core_time.h"
#include "tests/reference_camera.h"
#include "tests/src/temporary_folder.h"
#include "vision/tags/tag_detector.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

namespace fs = std::filesystem;

constexpr double tag_side_mm = 1.2;

cv::Mat machine_frame(int k) {
    static const plant::PlateView view = [] {
        Plate plate;
        for (int tag = 0; tag < 20; ++tag) plate.tags.push_back({tag, {2.0 * tag, 0.0}, tag_side_mm});
        return plant::PlateView(reference_camera(), plate, {});
    }();
    return view.render(std::array{10.0 + 0.0317 * k}, static_cast<std::uint64_t>(k));
}

/// A recording of the machine's own camera.
void make_recording(const fs::path& folder, int frames) {
    RecordingWriter writer(folder, {.name = "bench",
                                    .rig = "reference-rig",
                                    .experiment = "inspect",
                                    .columns = {.encoder = true},
                                    .camera = std::nullopt,
                                    .frames = true,
                                    .when_full = WhenFull::wait});
    for (int k = 0; k < frames; ++k)
        if (!writer.add_frame((k + 1) * 20 * ns_per_ms, machine_frame(k))) throw RunFault("disk");
    if (!writer.close()) throw RunFault("disk");
}

/// Writes the same frames as plain image files, without a recording's tables.
void make_image_folder(const fs::path& folder, int frames) {
    fs::create_directories(folder);
    for (int k = 0; k < frames; ++k)
        cv::imwrite((folder / fmt::format("{:04}.pgm", k)).string(), machine_frame(k));
}

/// Fills a folder with the test photographs, each of them `copies` times.
void make_photographs(const fs::path& folder, int copies) {
    fs::create_directories(folder);
    for (const auto& entry : fs::directory_iterator(fs::path(FIDSERVO_DATA_DIR) / "photos")) {
        const std::string ending = entry.path().extension();
        if (ending != ".jpg" && ending != ".pgm" && ending != ".png") continue;
        for (int copy = 0; copy < copies; ++copy)
            fs::copy(entry.path(), folder / fmt::format("{:03}-{}", copy, entry.path().filename().string()));
    }
}

struct Round {
    std::size_t images = 0;
    double alone_core_s = 0.0;  ///< decode and detect
    double wall_s = 0.0;        ///< replay
    double core_s = 0.0;        ///< of all its threads

    double ideal_wall_s(unsigned cores) const { return alone_core_s / cores; }
};

void decode_and_detect(const fs::path& input, Round& round) {
    ImageFrames frames({input});
    vision::TagDetector machine(vision::machine_camera_options()), thorough(vision::thorough_options());
    const double begin_s = core_time_s(CLOCK_THREAD_CPUTIME_ID);
    while (const auto frame = frames.next()) {
        auto& detector = frame->from_recording ? machine : thorough;
        benchmark::DoNotOptimize(detector.detect(decode(*frame), frame->time_ns.value_or(0)));
        ++round.images;
    }
    round.alone_core_s = core_time_s(CLOCK_THREAD_CPUTIME_ID) - begin_s;
}

void replay_all(const fs::path& input, const fs::path& out, unsigned cores, Round& round) {
    fs::create_directories(out);
    const double begin_core_s = core_time_s(CLOCK_PROCESS_CPUTIME_ID);
    const auto begin = std::chrono::steady_clock::now();
    ImageFrames frames({input});
    replay(frames, tag_side_mm, out, cores);
    round.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    round.core_s = core_time_s(CLOCK_PROCESS_CPUTIME_ID) - begin_core_s;
    fs::remove_all(out);
}

template <class Value>
std::vector<double> sorted(const std::vector<Round>& rounds, Value value) {
    std::vector<double> values(rounds.size());
    std::ranges::transform(rounds, values.begin(), value);
    std::sort(values.begin(), values.end());
    return values;
}

template <class Value>
double median(const std::vector<Round>& rounds, Value value) {
    return sorted(rounds, value)[rounds.size() / 2];
}

void run_rounds(benchmark::State& state, const fs::path& input, const fs::path& out) {
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    cv::setNumThreads(1);  // the reference is one core's work
    std::vector<Round> rounds;
    for (auto _ : state) {
        Round& round = rounds.emplace_back();
        decode_and_detect(input, round);
        replay_all(input, out, cores, round);
        state.SetIterationTime(round.wall_s);
    }
    const auto of_ideal = [=](const Round& round) { return round.ideal_wall_s(cores) / round.wall_s; };
    const auto images = [](const Round& round) { return static_cast<double>(round.images); };
    state.counters["of_ideal"] = median(rounds, of_ideal);
    state.counters["of_ideal_worst"] = sorted(rounds, of_ideal).front();
    state.counters["demand"] = 0.85;
    state.counters["core_time_ratio"] =
        median(rounds, [](const Round& round) { return round.core_s / round.alone_core_s; });
    state.counters["images_per_s"] =
        median(rounds, [=](const Round& round) { return images(round) / round.wall_s; });
    state.counters["one_core_images_per_s"] =
        median(rounds, [=](const Round& round) { return images(round) / round.alone_core_s; });
    state.counters["cores"] = cores;
}

void replay_recording(benchmark::State& state) {
    const testing::TemporaryFolder scratch;
    make_recording(scratch / "in", 200);
    run_rounds(state, scratch / "in", scratch / "out");
}

void replay_image_folder(benchmark::State& state) {
    const testing::TemporaryFolder scratch;
    make_image_folder(scratch / "in", 40);
    run_rounds(state, scratch / "in", scratch / "out");
}

void replay_photographs(benchmark::State& state) {
    if (!fs::exists(fs::path(FIDSERVO_DATA_DIR) / "photos")) {
        state.SkipWithError("no shared data");
        return;
    }
    const testing::TemporaryFolder scratch;
    make_photographs(scratch / "in", 8);
    run_rounds(state, scratch / "in", scratch / "out");
}

BENCHMARK(replay_recording)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);
BENCHMARK(replay_image_folder)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK(replay_photographs)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fidservo

BENCHMARK_MAIN();
