// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A channel map checked against the board: what the conversion between volts and the board's raw values
// needs.
#include "control/comedi/channel_map.h"

namespace fidservo {
struct Rig;
}

namespace fidservo::control::comedi {

/// A channel with the range it is used in.
struct Terminal {
    Address at;
    VoltageRange range{};
    std::uint32_t max_value = 0;
};

/// The raw value for a voltage in V, clipped to the range: 0 is range.low_V, max_value is range.high_V.
std::uint32_t number_of(const Terminal& terminal, double volts);
double volts_of(const Terminal& terminal, std::uint32_t number);

struct Wiring {
    Terminal macro;
    bool macro_reversed = false;
    std::optional<Terminal> direction;
    Terminal micro;
    Terminal hall;
    double hall_lsb_V = 0.0;  ///< voltage of one count of StageSample::hall_adc
    Terminal encoder;
    bool encoder_reversed = false;
    /// Counts per volt of a position on an analogue input; empty: the encoder is on a counter.
    std::optional<double> counts_per_V;
};

/// Throws InputError "stage.comedi.KEY: VALUE: message" where the board does not have a channel, where it is
/// of another kind, or where its range does not hold what the rig needs: the macro stage's limit, the
/// heater's limit, the Hall sensor's voltages over the travel, the whole travel of a position in volts.
/// @param rig  must have a micro stage
Wiring wire(const ChannelMap& map, const BoardLink& board, const Rig& rig);

}  // namespace fidservo::control::comedi
