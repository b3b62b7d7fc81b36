// A stage and a camera for a program on the other side of the kernel:
//
//     comedi_rig RIG.yaml PLATE.yaml COMEDI-NODE VIDEO-NODE SECONDS
//
// Reads the commands that the program gives to the analogue outputs 0 (motor) and 1 (heater) of comedi_test
// at its inputs, simulates the stage by the wall clock, and writes what its sensors show to the outputs 2
// (position, 20 mm/V, 0 V at 100 mm) and 3 (Hall sensor), which the program reads at the inputs 2 and 3.
// Frames of the plate, as the camera on that stage sees it, go to v4l2loopback. Prints a line when it is
// ready, and the camera's true place and the commands in force once a second.
#include "control/comedi/libcomedi_link.h"
#include "control/comedi/wiring.h"
#include "control/guardian_process.h"
#include "core/monotonic_clock.h"
#include "core/rig.h"
#include "src/config/plate_file.h"
#include "src/config/rig_file.h"
#include "tests/live_rig.h"
#include "tests/vm/loopback_feed.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

namespace {

using namespace fidservo;
using namespace control::comedi;

constexpr Terminal channel(int subdevice, int number) {
    return {{subdevice, number, 1}, {-5.0, 5.0}, 0xffff};  // comedi_test's second range
}

constexpr std::chrono::milliseconds step{1};

/// The rig in steps that are short against the program's ticks: it goes on between them.
Rig in_short_steps(Rig rig) {
    const double step_s = std::chrono::duration<double>(step).count();
    rig.macro.velocity_pole = std::pow(rig.macro.velocity_pole, step_s / rig.tick_s);
    rig.tick_s = step_s;
    return rig;
}

/// What the outputs were last seen to command.
struct Commanded {
    std::atomic<double> macro_V{0.0}, micro_V{0.0};
};

/// The stage's electronics.
void drive(LiveRig& rig, const Rig& file, BoardLink& board, Commanded& commanded,
           const std::stop_token& stop) {
    constexpr double mm_per_V = 20.0, middle_mm = 100.0;
    control::take_real_time_priority();
    const double lsb_V = hall_lsb_V(file.micro->hall);
    while (!stop.stop_requested()) {
        std::uint32_t motor = 0, heater = 0;
        if (!board.read(channel(0, 0).at, motor) || !board.read(channel(0, 1).at, heater)) std::abort();
        const double macro_V = volts_of(channel(0, 0), motor), micro_V = volts_of(channel(0, 1), heater);
        rig.command(macro_V, micro_V);
        commanded.macro_V = macro_V;
        commanded.micro_V = micro_V;
        const plant::StageReading reading = rig.read(monotonic_now_ns());
        const double position_V = (rig.carriage_mm() - middle_mm) / mm_per_V;
        if (!board.write(channel(1, 2).at, number_of(channel(1, 2), position_V)) ||
            !board.write(channel(1, 3).at, number_of(channel(1, 3), reading.hall_adc * lsb_V)))
            std::abort();
        std::this_thread::sleep_for(step);
    }
}

/// Every frame is shown as late after its exposure as the rig file says, or as soon as it is rendered.
void film(LiveRig& rig, const CameraParameters& camera, devices::LoopbackFeed& feed,
          const std::stop_token& stop) {
    const TimeNs period_ns = nanoseconds(1.0 / camera.frame_rate_hz);
    TimeNs next_ns = monotonic_now_ns();
    for (std::uint64_t frame = 0; !stop.stop_requested(); ++frame) {
        const TimeNs exposed_ns = next_ns + nanoseconds(camera.exposure_s);
        while (monotonic_now_ns() < exposed_ns) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const cv::Mat image = rig.frame_at(next_ns, frame);
        const TimeNs shown_ns = next_ns + nanoseconds(camera.latency_s);
        while (monotonic_now_ns() < shown_ns) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        feed.show(image);
        next_ns = std::max(next_ns + period_ns, monotonic_now_ns() - period_ns);
    }
}

int run(char** arguments) {
    const Rig file = in_short_steps(load_rig(arguments[1]));
    const Plate plate = load_plate(arguments[2]);
    const double duration_s = std::atof(arguments[5]);
    const auto board = open_board(arguments[3]);
    const CameraParameters& camera = file.camera.value();
    devices::LoopbackFeed feed(arguments[4], vision::v4l2::PixelFormat::grey,
                               {camera.geometry.width_px, camera.geometry.height_px});
    LiveRig rig(file, plate, 30.0, 5);
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
    if (count != 6) return 2;
    try {
        return run(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "comedi_rig: %s\n", error.what());
        return 3;
    }
}
