// SPDX-License-Identifier: GPL-3.0-or-later
// Where the last micrometre of a fiducial-relative motion goes: random targets on the simulated rig, the
// truth known here only. For every target, at the tick of arrival and along the stage axis,
//
//     error = stop - camera + rest
//     stop    what the supervisor measured and left as it was: inside its tolerance
//     camera  measured minus true offset, over the two confirming frames
//     rest    how far the stage went from the middle of those frames until the arrival
//
// and hold, how far it goes in the second after. What `stop` is made of is told by rigs with one part
// idealised: a Hall sensor without noise at 20 bit, a camera with hardly any noise, both.
//
//     positioning_bench [TARGETS [SEED]]
#include "core/random.h"
#include "core/result.h"
#include "core/rig.h"
#include "core/units.h"
#include "tests/session/watched_rig.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace fidservo {
namespace {

class WatchedCamera final : public vision::Camera {
  public:
    explicit WatchedCamera(std::shared_ptr<SimulatedRig> rig) : camera_(std::move(rig)) {}
    Result<std::optional<vision::Frame>> poll(TimeNs now_ns) override {
        auto frame = camera_.poll(now_ns);
        if (frame && *frame) times_ns.push_back((*frame)->time_ns);
        return frame;
    }
    std::vector<TimeNs> times_ns;  ///< of all frames that were handed out

  private:
    SimulatedCamera camera_;
};

struct Case {
    const char* name;
    double tolerance_um;
    std::function<void(Rig&)> idealise;
};

/// Root mean square and worst magnitude of a quantity.
struct Spread {
    double squares = 0.0, worst = 0.0;
    int count = 0;
    void add(double value) {
        squares += value * value;
        worst = std::max(worst, std::abs(value));
        ++count;
    }
    double rms() const { return std::sqrt(squares / count); }
};

struct Share {
    Spread error, stop, camera, rest, hold, normalised, moves, micro_s;
    int missed = 0;
};

Share measure(const Case& of, int targets, std::uint64_t seed) {
    Rig file = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    of.idealise(file);
    const Plate plate = plate_of(file.fiducials.value());
    auto rig = std::make_shared<SimulatedRig>(plant::plant_parameters(file), *file.camera, plate, seed);
    auto stage = std::make_shared<WatchedStage>(rig);
    auto camera = std::make_shared<WatchedCamera>(rig);
    SessionOptions options;
    options.tolerance_um = of.tolerance_um;
    Session session(options, file, plate, Devices{stage, camera});
    if (auto homed = session.home(); !homed) throw std::runtime_error(homed.error().text);

    const auto truth_mm = [&](double time_s) {
        const double tick = time_s / file.tick_s;
        const auto before = static_cast<std::size_t>(tick);
        const double part = tick - static_cast<double>(before);
        return (1 - part) * plant::camera_position_mm(stage->history.at(before)) +
               part * plant::camera_position_mm(stage->history.at(before + 1));
    };
    NoiseStream draw(seed, "targets");
    Share share;
    for (int i = 0; i < targets; ++i) {
        const int tag = 1 + static_cast<int>(99.0 * draw.uniform());
        const double dx_mm = 3.0 * (draw.uniform() - 0.5);
        const double target_mm = 2.0 * tag + dx_mm;
        const auto arrival = session.go_to(tag, dx_mm);
        if (!arrival) {
            ++share.missed;
            continue;
        }
        const double there_mm = plant::camera_position_mm(stage->history.back());
        const auto& times_ns = camera->times_ns;
        const double seen_mm = 0.5 * (truth_mm(seconds(times_ns.at(times_ns.size() - 1))) +
                                      truth_mm(seconds(times_ns.at(times_ns.size() - 2))));
        const double stop_um = arrival->reached_dx_um - arrival->target_dx_um;
        const double error_um = um_from_mm(there_mm - target_mm);
        share.error.add(error_um);
        share.stop.add(stop_um);
        share.camera.add(stop_um - um_from_mm(seen_mm - target_mm));
        share.rest.add(um_from_mm(there_mm - seen_mm));
        share.normalised.add((stop_um - error_um) / arrival->reached_std_um);
        share.moves.add(arrival->micro_moves);
        share.micro_s.add(arrival->micro_time_s);
        if (auto held = session.hold(1.0); !held) throw std::runtime_error(held.error().text);
        share.hold.add(um_from_mm(plant::camera_position_mm(stage->history.back()) - there_mm));
    }
    return share;
}

void print(const Case& of, const Share& share) {
    std::printf("%-22s %9.2f |%6.3f %6.3f |%6.3f %7.4f %7.4f %7.4f |%9.2f %7.2f |%6.2f %4.0f %7.3f %6d\n",
                of.name, of.tolerance_um, share.error.rms(), share.error.worst, share.stop.rms(),
                share.camera.rms(), share.rest.rms(), share.hold.rms(), share.normalised.rms(),
                share.normalised.worst, share.moves.rms(), share.moves.worst, share.micro_s.rms(),
                share.missed);
    std::fflush(stdout);
}

/// Of the variance of the final error, at the first case's tolerance.
void print_shares(const Share& as_it_is, const Share& ideal_hall) {
    const auto variance = [](const Spread& of) { return of.rms() * of.rms(); };
    const double whole = variance(as_it_is.error);
    const double camera = variance(as_it_is.camera) / whole;
    const double hall = 1.0 - variance(ideal_hall.error) / whole;
    const double rest = variance(as_it_is.rest) / whole;
    std::printf(
        "shares of the error's variance: camera %.1e, Hall sensor %.2f, motion after the frames %.1e, "
        "actuator within the tolerance %.2f\n",
        camera, hall, rest, 1.0 - hall - camera - rest);
}

int run(int targets, std::uint64_t seed) {
    const auto as_it_is = [](Rig&) {};
    const auto ideal_hall = [](Rig& rig) {
        rig.micro->hall.noise_lsb = 0.0;
        rig.micro->hall.adc_bits = 20;
    };
    const auto ideal_camera = [](Rig& rig) {
        rig.camera->full_well_e = 1e8;
        rig.camera->read_noise_e = 0.0;
    };
    const auto both = [&](Rig& rig) {
        ideal_hall(rig);
        ideal_camera(rig);
    };
    const std::array cases{Case{"as it is", 1.0, as_it_is},
                           Case{"ideal Hall sensor", 1.0, ideal_hall},
                           Case{"ideal camera", 1.0, ideal_camera},
                           Case{"both ideal", 1.0, both},
                           Case{"as it is", 0.5, as_it_is},
                           Case{"as it is", 0.25, as_it_is},
                           Case{"ideal Hall sensor", 0.25, ideal_hall}};
    std::printf("%d random targets each, seed %llu; r.m.s. in um unless it says worst\n", targets,
                static_cast<unsigned long long>(seed));
    std::printf("%-22s %9s |%6s %6s |%6s %7s %7s %7s |%9s %7s |%6s %4s %7s %6s\n", "rig", "tolerance",
                "error", "worst", "stop", "camera", "rest", "hold", "error/std", "worst", "moves", "most",
                "micro s", "missed");
    std::vector<Share> shares;
    for (const Case& of : cases) {
        shares.push_back(measure(of, targets, seed));
        print(of, shares.back());
    }
    print_shares(shares[0], shares[1]);
    return 0;
}

}  // namespace
}  // namespace fidservo

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const int targets = argc > 1 ? std::atoi(argv[1]) : 200;
    const auto seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2026ULL;
    return fidservo::run(targets, seed);
}
