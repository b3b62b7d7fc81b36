// SPDX-License-Identifier: GPL-3.0-or-later
// A stage and a camera for a program on the other side of the kernel:
//
//     comedi_rig RIG.yaml PLATE.yaml COMEDI-NODE VIDEO-NODE SECONDS [NAME:PARAMETER=VALUE,...]...
//
// Reads the commands that the program gives to the analogue outputs 0 (motor) and 1 (heater) of comedi_test
// at its inputs every millisecond, simulates the stage by the clock, and writes what its sensors show to the
// outputs 2 (position, 20 mm/V, 0 V at 100 mm) and 3 (Hall sensor), which the program reads at the inputs 2
// and 3. Frames of the plate, as the camera on that stage sees it, go to v4l2loopback. The stage and its
// camera have the effects that are given, which the file need not state; not those that the board's inputs or
// a frame's time would have to show (encoder_scale, camera_latency and their like). Prints a line when it is
// ready, and the camera's true place and the commands in force once a second.
#include "control/comedi/libcomedi_link.h"
#include "control/comedi/wiring.h"
#include "control/guardian_process.h"
#include "core/monotonic_clock.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "tests/live_rig.h"
#include "tests/vm/loopback_feed.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <thread>
#include <vector>

namespace {

using namespace fidservo;
using namespace control::comedi;

constexpr Terminal channel(int subdevice, int number) {
    return {{subdevice, number, 1}, {-5.0, 5.0}, 0xffff};  // comedi_test's second range
}

constexpr TimeNs step_ns = ns_per_ms;

/// The rig in steps that are short against the program's ticks: it goes on between them.
Rig in_short_steps(Rig rig) {
    const double step_s = seconds(step_ns);
    rig.macro.velocity_pole = std::pow(rig.macro.velocity_pole, step_s / rig.tick_s);
    rig.tick_s = step_s;
    return rig;
}

/// What the outputs were last seen to command.
struct Commanded {
    std::atomic<double> macro_V{0.0}, micro_V{0.0};
};

void sleep_until(TimeNs time_ns) {
    const timespec until{time_ns / ns_per_s, time_ns % ns_per_s};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

/// Sleeps until the first whole step from a time on that is not yet over.
TimeNs next_step(TimeNs from_ns) {
    const TimeNs over = (monotonic_now_ns() - from_ns) / step_ns;
    const TimeNs next_ns = from_ns + (over + 1) * step_ns;
    sleep_until(next_ns);
    return next_ns;
}

/// The stage's electronics.
void drive(LiveRig& rig, const Rig& file, BoardLink& board, Commanded& commanded,
           const std::stop_token& stop) {
    constexpr double mm_per_V = 20.0, middle_mm = 100.0;
    control::take_real_time_priority();
    const double lsb_V = hall_lsb_V(file.micro->hall);
    for (TimeNs now_ns = monotonic_now_ns(); !stop.stop_requested(); now_ns = next_step(now_ns)) {
        std::uint32_t motor = 0, heater = 0;
        if (!board.read(channel(0, 0).at, motor) || !board.read(channel(0, 1).at, heater)) std::abort();
        const double macro_V = volts_of(channel(0, 0), motor), micro_V = volts_of(channel(0, 1), heater);
        const plant::StageReading reading = rig.follow(macro_V, micro_V, now_ns);
        commanded.macro_V = macro_V;
        commanded.micro_V = micro_V;
        const double position_V = (rig.carriage_mm() - middle_mm) / mm_per_V;
        if (!board.write(channel(1, 2).at, number_of(channel(1, 2), position_V)) ||
            !board.write(channel(1, 3).at, number_of(channel(1, 3), reading.hall_adc * lsb_V)))
            std::abort();
    }
}

/// Every frame is shown as late after its exposure as the rig file says, or as soon as it is rendered.
void film(LiveRig& rig, const CameraParameters& camera, devices::LoopbackFeed& feed,
          const std::stop_token& stop) {
    const TimeNs period_ns = nanoseconds(1.0 / camera.frame_rate_hz);
    TimeNs next_ns = monotonic_now_ns();
    for (std::uint64_t frame = 0; !stop.stop_requested(); ++frame) {
        // By then the stage has been simulated up to the end of the exposure.
        sleep_until(next_ns + nanoseconds(camera.exposure_s) + 2 * step_ns);
        const cv::Mat image = rig.frame_at(next_ns, frame);
        sleep_until(next_ns + nanoseconds(camera.latency_s));
        feed.show(image);
        next_ns = std::max(next_ns + period_ns, monotonic_now_ns() - period_ns);
    }
}

int run(char** arguments, const std::vector<plant::EffectSetting>& effects) {
    const Rig file = in_short_steps(load_rig(arguments[1]));
    const Plate plate = load_plate(arguments[2]);
    const double duration_s = std::atof(arguments[5]);
    const auto board = open_board(arguments[3]);
    const CameraParameters& camera = file.camera.value();
    devices::LoopbackFeed feed(arguments[4], vision::v4l2::PixelFormat::grey,
                               {camera.geometry.width_px, camera.geometry.height_px});
    LiveRig rig(file, plate, 30.0, 5, effects);
    Commanded commanded;
    const std::jthread stage([&](const std::stop_token& stop) { drive(rig, file, *board, commanded, stop); });
    const std::jthread eye([&](const std::stop_token& stop) { film(rig, camera, feed, stop); });
    for (double passed_s = 0.0; passed_s < duration_s; passed_s += 1.0) {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        std::printf("truth: camera at %.4f mm; motor %.3f V, heater %.3f V\n",
                    rig.camera_mm(monotonic_now_ns()), commanded.macro_V + 0.0, commanded.micro_V + 0.0);
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    constexpr int needed = 6;
    if (count < needed) return 2;
    try {
        std::vector<plant::EffectSetting> effects;
        for (int k = needed; k < count; ++k) effects.push_back(plant::parse_effect(arguments[k]));
        return run(arguments, effects);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "comedi_rig: %s\n", error.what());
        return 3;
    }
}
