// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wire as thousands of relays with random switching temperatures: Preisach's model by its definition,
// without tables or grids, for checking fits that use tables.
#include "calib/wire/preisach_data.h"
#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fidservo::calib {

class RelayWire {
  public:
    static constexpr double stroke_mm = 4.0;

    /// Relays switch on at about 75 degC, off 10 to 30 degC lower; all off at first.
    explicit RelayWire(std::uint64_t seed, std::size_t relays = 4000) {
        NoiseStream draw(seed, "relays");
        for (std::size_t i = 0; i < relays; ++i) {
            const double on_degC = 75.0 + 7.0 * draw.normal();
            relays_.push_back({on_degC, on_degC - std::max(0.5, 20.0 + 4.0 * draw.normal()), false});
        }
    }

    double move(double temp_degC) {
        std::size_t on = 0;
        for (Relay& relay : relays_) {
            if (temp_degC >= relay.on_degC) relay.on = true;
            if (temp_degC < relay.off_degC) relay.on = false;
            on += relay.on;
        }
        return stroke_mm * static_cast<double>(on) / static_cast<double>(relays_.size());
    }

  private:
    struct Relay {
        double on_degC, off_degC;
        bool on;
    };
    std::vector<Relay> relays_;
};

/// From `start` to each of the turns in steps of at most `step`, each turn held for ten samples.
inline std::vector<double> ramps(double start, const std::vector<double>& turns, double step) {
    std::vector<double> course{start};
    for (const double turn : turns) {
        const double from = course.back();
        const int n = static_cast<int>(std::ceil(std::abs(turn - from) / step));
        for (int i = 1; i <= n; ++i) course.push_back(from + (turn - from) * i / n);
    }
    return course;
}

/// Cycles from 25 degC to peaks of 110, 105, ... degC and back.
inline std::vector<double> kiln_turns() {
    std::vector<double> turns;
    for (double peak = 110.0; peak > 55.0; peak -= 5.0) turns.insert(turns.end(), {peak, 25.0});
    return turns;
}

/// The recording of a thermometer with noise and an encoder with steps.
inline HysteresisTrace record_wire(const std::vector<double>& temp_degC, std::uint64_t seed,
                                   double noise_degC, double encoder_mm) {
    RelayWire wire(seed);
    NoiseStream noise(seed, "thermometer");
    HysteresisTrace trace;
    for (const double temp : temp_degC) {
        trace.input.push_back(temp + noise_degC * noise.normal());
        const double x_mm = wire.move(temp);
        trace.output.push_back(encoder_mm > 0.0 ? encoder_mm * std::floor(x_mm / encoder_mm + 0.5) : x_mm);
    }
    return trace;
}

/// A sequence of turning points, uniform over 30..105 degC, from cold, the hottest one first.
inline std::vector<double> random_turns(std::uint64_t seed, std::size_t count) {
    NoiseStream draw(seed, "turns");
    std::vector<double> turns{110.0, 25.0};
    while (turns.size() < count) turns.push_back(30.0 + 75.0 * draw.uniform());
    return turns;
}

}  // namespace fidservo::calib
