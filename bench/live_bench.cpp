// SPDX-License-Identifier: GPL-3.0-or-later
// The live page against the run it shows.
//
//   stop    from the moment at which a browser sends "stop" until the stage's outputs are zero at the board,
//   in
//           mid-run; limit 50 ms
//   viewer  how much longer an inspection takes while somebody watches it, in turns with the same without;
//   and
//           its processor time, which other work on the machine does not lengthen
//
//     live_bench [STOPS [TURNS]]
#include "control/output_board.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <httplib.h>
#include <sys/resource.h>

namespace fidservo {
namespace {

using namespace std::chrono_literals;
using control::SimulatedBoard;
using std::chrono::steady_clock;
using testing::ChildProcess;

double ms_since(steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(steady_clock::now() - start).count();
}

/// An inspection in a folder of its own, with a live page.
class ShownRun {
  public:
    explicit ShownRun(bool live)
        : run_({"/bin/sh", "-c",
                "export TMPDIR='" + folder_.path().string() +
                    "'; exec '" FIDSERVO_PROGRAM "' inspect '" FIDSERVO_SOURCE_DIR
                    "/tests/faults/drill.yaml' --out '" +
                    (folder_ / "out").string() + (live ? "' --live 0" : "'")}) {
        if (!live) return;
        const std::string mark = "live: http://127.0.0.1:";
        if (!run_.prints("/\n", 60s)) throw std::runtime_error(run_.output());
        port_ = std::stoi(run_.output().substr(run_.output().find(mark) + mark.size()));
    }

    bool is_off() const {
        const auto outputs = SimulatedBoard::outputs(board());
        return outputs.macro_V == 0.0 && outputs.micro_V == 0.0;
    }
    std::filesystem::path board() const { return folder_ / "board"; }
    /// Keeps the board's registers by a link: the program's go with its folder.
    void keep_board() const {
        std::filesystem::create_hard_link(
            folder_ / ("fidservo-" + std::to_string(run_.pid()) + "/stage-outputs"), board());
    }
    httplib::Client client() const { return httplib::Client("127.0.0.1", port_); }
    ChildProcess& process() { return run_; }

  private:
    testing::TemporaryFolder folder_;
    ChildProcess run_;
    int port_ = 0;
};

double stop_ms(int turn) {
    ShownRun run(true);
    run.keep_board();
    while (run.is_off()) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + 37 * (turn % 20)));
    while (run.is_off()) std::this_thread::sleep_for(1ms);
    auto client = run.client();
    const auto start = steady_clock::now();
    client.Post("/stop");
    while (!run.is_off()) std::this_thread::sleep_for(100us);
    const double took_ms = ms_since(start);
    run.process().wait();
    if (!run.is_off()) throw std::runtime_error("the outputs came back");
    return took_ms;
}

/// User and system time of all children that have ended, s.
double children_s() {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct RunTime {
    double wall_s, processor_s;
};

RunTime time_of_run(bool watched) {
    const auto start = steady_clock::now();
    const double before_s = children_s();
    ShownRun run(watched);
    std::thread viewer;
    if (watched)
        viewer = std::thread([client = run.client()]() mutable {
            std::size_t bytes = 0;
            client.Get("/events", [&](const char*, std::size_t count) { return (bytes += count) > 0; });
        });
    run.process().output_ends(300s);
    const double took_ms = ms_since(start);
    if (run.process().wait() != 0) throw std::runtime_error(run.process().output());
    if (viewer.joinable()) viewer.join();
    return {1e-3 * took_ms, children_s() - before_s};
}

void bench(int stops, int turns) {
    std::vector<double> times_ms;
    times_ms.reserve(static_cast<std::size_t>(stops));
    for (int k = 0; k < stops; ++k) times_ms.push_back(stop_ms(k));
    std::ranges::sort(times_ms);
    if (stops > 0)
        std::printf("stop, ms:      median %.1f   p90 %.1f   worst %.1f   of %d; limit 50\n",
                    times_ms[times_ms.size() / 2], times_ms[times_ms.size() * 9 / 10], times_ms.back(),
                    stops);
    for (int k = 0; k < turns; ++k) {
        const RunTime alone = time_of_run(false), watched = time_of_run(true);
        std::printf(
            "a whole run, s: %.2f alone   %.2f watched; of processor time %.2f alone   %.2f watched\n",
            alone.wall_s, watched.wall_s, alone.processor_s, watched.processor_s);
    }
}

}  // namespace
}  // namespace fidservo

int main(int argc, char** argv) {
    // Options of Google Benchmark, which ./run bench gives to all, are not meant here.
    const auto number = [&](int k, int otherwise) {
        return argc > k && argv[k][0] != '-' ? std::atoi(argv[k]) : otherwise;
    };
    try {
        fidservo::bench(number(1, 30), number(2, 3));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "live_bench: %s\n", error.what());
        return 1;
    }
}
