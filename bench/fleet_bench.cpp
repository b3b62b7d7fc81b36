// SPDX-License-Identifier: GPL-3.0-or-later
// Fleets, by the program itself.
//
//   report     drawn results of UNITS by WEEKS: the report made (the database from nothing), its peak memory,
//   and its
//              page opened in Chromium, from the navigation's start until it is drawn; limits 20 s, 500 MB, 2
//              s
//   campaigns  UNITS by WEEKS campaigns that the independent model recorded: one task a core on two cores
//   against one
//              after the other on one; limit 1.9. With it the start-up of a shard that finds everything done,
//              and from task times and start-up the efficiency of 10,000 campaigns on 64 cores in an array of
//              as many shards
//   replay     IMAGES in 16 shards, two at a time, against one process on both cores; limit 0.97
//
//     fleet_bench [report [UNITS WEEKS] | campaigns [UNITS WEEKS] | replay [IMAGES]]
//
// Processor time is told beside the time that passes: other work on the machine lengthens only the latter.
#include "plant/view/plate_view.h"
#include "tests/fleet_report/drawn_fleet.h"
#include "tests/live/page_time.h"
#include "tests/reference_camera.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// What a process took, with all processes that it waited for.
struct Taken {
    double wall_s = 0.0, core_s = 0.0, peak_MB = 0.0;
};

pid_t started(const Words& command) {
    std::fflush(nullptr);
    const pid_t id = ::fork();
    if (id != 0) return id;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(127);
}

/// Runs commands, so many at a time, until all have ended. @param most  exit code that is all right
Taken run(const std::vector<Words>& commands, std::size_t at_once = 1, int most = 1) {
    const auto begin = std::chrono::steady_clock::now();
    Taken taken;
    std::size_t next = 0, working = 0;
    while (next < commands.size() || working > 0) {
        if (next < commands.size() && working < at_once) {
            (void)started(commands[next++]);
            ++working;
            continue;
        }
        int status = 0;
        rusage used{};
        if (::wait4(-1, &status, 0, &used) < 0) throw std::runtime_error("a process was lost");
        --working;
        if (!WIFEXITED(status) || WEXITSTATUS(status) > most)
            throw std::runtime_error(fmt::format("{} {}: failed", commands[0][0], commands[0][1]));
        const auto seconds = [](const timeval& time) {
            return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
        };
        taken.core_s += seconds(used.ru_utime) + seconds(used.ru_stime);
        taken.peak_MB = std::max(taken.peak_MB, 1024e-6 * static_cast<double>(used.ru_maxrss));
    }
    taken.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return taken;
}

std::string shard(std::size_t number, std::size_t of) {
    return fmt::format("{}/{}", number, of);
}

/// One unit in a hundred has an effect of its own, and one in a hundred drifts.
fleet::DrawnFleet drawn_fleet(std::size_t units, std::size_t weeks) {
    fleet::DrawnFleet drawn;
    drawn.seed = 41;
    drawn.units = units;
    drawn.weeks = weeks;
    drawn.truth = [](std::size_t effect, std::size_t unit, std::size_t week) {
        if (unit % 100 == 7) return effect == 1 ? 6.0 : 0.0;
        if (unit % 100 == 57) return effect == 4 ? 0.5 * static_cast<double>(week) : 0.0;
        return 0.0;
    };
    return drawn;
}

void bench_report(std::size_t units, std::size_t weeks) {
    const testing::TemporaryFolder folder;
    const fs::path fleet = folder / "fleet", page = folder / "fleet.html";
    fs::create_directories(fleet / "results");
    for (const fleet::FleetResult& result : fleet::draw(drawn_fleet(units, weeks)))
        std::ofstream(fleet / "results" / result.file) << fleet::file_text(result);
    const auto report = [&](const fs::path& html) {
        return run({{FIDSERVO_PROGRAM, "fleet", "report", fleet.string(), "--html", html.string(), "--json",
                     html.string() + ".json"}});
    };
    const Taken first = report(page), again = report(folder / "again.html");
    std::printf(
        "report of %zu results of %zu units: %.2f s (core %.2f s), again %.2f s (core %.2f s), peak %.0f "
        "MB\n",
        units * weeks, units, first.wall_s, first.core_s, again.wall_s, again.core_s, first.peak_MB);
    std::printf("its page: %.1f MB", 1e-6 * static_cast<double>(fs::file_size(page)));
    std::vector<double> drawn_s;
    for (int round = 0; round < 3; ++round)
        if (const auto time_s = testing::page_drawn_s(page, folder / fmt::format("profile-{}", round)))
            drawn_s.push_back(*time_s);
    std::ranges::sort(drawn_s);
    if (drawn_s.empty())
        std::printf("; there is no Chromium to open it\n");
    else
        std::printf(", drawn %.2f s after the navigation began, worst of three %.2f s\n", drawn_s[1],
                    drawn_s[2]);
}

/// Of some campaigns, by a program for each; its start-up is in it.
std::vector<double> core_times_of(const Words& diagnose, std::size_t count, const fs::path& out) {
    constexpr std::size_t most = 100;
    std::vector<double> core_s;
    const std::size_t first = diagnose.size() - count, step = std::max<std::size_t>(1, count / most);
    for (std::size_t k = first; k < diagnose.size(); k += step) {
        Words command(diagnose.begin(), diagnose.begin() + static_cast<std::ptrdiff_t>(first));
        command.insert(command.end(), {diagnose[k], "--jobs", "1", "--out", out.string()});
        core_s.push_back(run({command}).core_s);
    }
    return core_s;
}

/// 10,000 tasks whose times are drawn from those measured, on 64 cores, each of which takes the next shard
/// when it is free. Each shard has a start-up. Efficiency: what the tasks alone take, over what 64 cores are
/// held for.
void print_scaling(const std::vector<double>& task_s, double start_up_s) {
    constexpr std::size_t tasks = 10'000, cores = 64;
    constexpr unsigned seed = 41;
    std::mt19937_64 generator(seed);
    std::uniform_int_distribution<std::size_t> any(0, task_s.size() - 1);
    std::vector<double> times(tasks);
    for (double& time : times) time = std::max(0.0, task_s[any(generator)] - start_up_s);
    const double work_s = std::accumulate(times.begin(), times.end(), 0.0);
    std::printf("a task takes core %.2f s on average, %.2f s at most; a shard's start-up core %.3f s\n",
                work_s / static_cast<double>(tasks), std::ranges::max(task_s), start_up_s);
    for (const std::size_t shards : std::array<std::size_t, 3>{64, 256, 1024}) {
        std::vector<double> free_at(cores, 0.0);
        for (std::size_t shard = 0; shard < shards; ++shard) {
            double& core = *std::ranges::min_element(free_at);
            core += start_up_s;
            for (std::size_t task = shard; task < tasks; task += shards) core += times[task];
        }
        const double end_s = std::ranges::max(free_at);
        std::printf("10,000 such campaigns on 64 cores in %zu shards: %.0f s, efficiency %.3f\n", shards,
                    end_s, work_s / (static_cast<double>(cores) * end_s));
    }
}

void bench_campaigns(std::size_t units, std::size_t weeks) {
    const testing::TemporaryFolder folder;
    const std::string rig = FIDSERVO_ASSETS_DIR "/rig.yaml";
    const std::size_t count = units * weeks;
    const Taken recorded = run({{FIDSERVO_WRITE_FLEET, (folder / "recordings").string(), rig,
                                 std::to_string(units), std::to_string(weeks), "41", "macro-square-1"}});
    std::printf("%zu campaigns of one recording each, recorded in core %.1f s\n", count, recorded.core_s);
    Words diagnose{FIDSERVO_PROGRAM, "fleet", "diagnose", "--rig", rig, "--effort", "4"};
    for (const auto& unit : fs::directory_iterator(folder / "recordings"))
        for (const auto& week : fs::directory_iterator(unit)) diagnose.push_back(week.path().string());
    const auto into = [&](const char* out, const Words& more) {
        Words command = diagnose;
        command.insert(command.end(), {"--out", (folder / out).string()});
        command.insert(command.end(), more.begin(), more.end());
        return command;
    };
    const Taken one = run({into("one", {"--jobs", "1"})}), two = run({into("two", {"--jobs", "2"})});
    std::printf(
        "one after the other: %.1f s (core %.1f s); one task a core on two cores: %.1f s (core %.1f s): "
        "%.3f times as many a second\n",
        one.wall_s, one.core_s, two.wall_s, two.core_s, one.wall_s / two.wall_s);
    const Taken nothing = run({into("one", {"--jobs", "1", "--shard", "1/64"})});
    print_scaling(core_times_of(diagnose, count, folder / "each"), nothing.core_s);
}

void write_images(const fs::path& folder, int count) {
    constexpr int different = 200;
    fs::create_directories(folder);
    Plate plate;
    for (int tag = 0; tag < 20; ++tag) plate.tags.push_back({tag, {2.0 * tag, 0.0}, 1.2});
    const plant::PlateView view(reference_camera(), plate, {});
    const auto file_of = [&](int k) { return folder / fmt::format("{:06}.png", k); };
    for (int k = 0; k < count; ++k) {
        if (k < different)
            cv::imwrite(file_of(k),
                        view.render(std::array{10.0 + 0.0317 * k}, static_cast<std::uint64_t>(k)));
        else
            fs::create_hard_link(file_of(k % different), file_of(k));
    }
}

void bench_replay(int images) {
    constexpr std::size_t shards = 16;
    const testing::TemporaryFolder folder;
    write_images(folder / "images", images);
    const std::string in = (folder / "images").string();
    const Taken whole = run({{FIDSERVO_PROGRAM, "replay", in, "--out", (folder / "one").string()}});
    std::vector<Words> commands;
    for (std::size_t k = 1; k <= shards; ++k)
        commands.push_back({FIDSERVO_PROGRAM, "fleet", "replay", in, "--out", (folder / "many").string(),
                            "--shard", shard(k, shards), "--jobs", "1"});
    const Taken sharded = run(commands, 2);
    std::printf(
        "%d images: one process %.1f s (core %.1f s); in %zu shards, two at a time, %.1f s (core %.1f s): "
        "%.3f times as many a second, %.3f by core time\n",
        images, whole.wall_s, whole.core_s, shards, sharded.wall_s, sharded.core_s,
        whole.wall_s / sharded.wall_s, whole.core_s / sharded.core_s);
    for (const char* table : {"detections.csv", "displacements.csv"})
        if (testing::text_of(folder / "one" / table) != testing::text_of(folder / "many" / table))
            throw std::runtime_error(fmt::format("{}: is not the same in shards", table));
}

std::size_t number(const Words& words, std::size_t place, std::size_t usual) {
    return place < words.size() ? std::stoul(words[place]) : usual;
}

void bench(const Words& words) {
    const std::string what = words.empty() ? "" : words[0];
    if (what.empty() || what == "report") bench_report(number(words, 1, 1000), number(words, 2, 10));
    if (what.empty() || what == "campaigns") bench_campaigns(number(words, 1, 50), number(words, 2, 8));
    if (what.empty() || what == "replay") bench_replay(static_cast<int>(number(words, 1, 100'000)));
}

}  // namespace
}  // namespace fidservo

int main(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    std::erase_if(words, [](std::string_view word) { return word.starts_with("--"); });
    try {
        fidservo::bench(words);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fleet_bench: %s\n", error.what());
        return 1;
    }
}
