// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A stage behind a microcontroller at the end of a wire. This is the file to write for hardware of one's own.
#include "control/stage.h"
#include "core/failure.h"

#include <cstdio>
#include <functional>
#include <string>
#include <utility>

/// Sends a line and waits for the answer: of a real wire, a write() and a read() of its device.
using Wire = std::function<std::string(const std::string& line)>;

/// "r" is answered by "TIME_NS COUNT ADC" at the next tick, "w MACRO_V MICRO_V" by "ok". The microcontroller
/// keeps the tick, and switches both outputs off when no command has come for 20 ms: nobody else can when
/// this process is gone.
class WiredStage final : public fidservo::control::Stage {
  public:
    explicit WiredStage(Wire wire) : wire_(std::move(wire)) {}

    fidservo::Result<fidservo::control::StageSample> read() override {
        fidservo::control::StageSample sample;
        long long time_ns = 0, count = 0;
        if (std::sscanf(wire_("r").c_str(), "%lld %lld %d", &time_ns, &count, &sample.hall_adc) != 3)
            return refused("the microcontroller does not answer");
        sample.time_ns = time_ns;
        sample.encoder_count = count;
        return sample;
    }

    fidservo::Status write(const fidservo::control::StageCommand& command) override {
        char line[64];
        std::snprintf(line, sizeof line, "w %.6f %.6f", command.macro_V, command.micro_V);
        return wire_(line) == "ok" ? fidservo::Status() : refused("the microcontroller refused a command");
    }

  private:
    static tl::unexpected<fidservo::Failure> refused(const char* why) {
        return fidservo::failure(fidservo::Reason::device, why);
    }

    Wire wire_;
};
