// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which of a board's channels the stage is wired to.
#include "control/comedi/board_link.h"

#include <optional>

namespace fidservo::control::comedi {

struct ChannelChoice {
    int subdevice = 0;
    int channel = 0;
    std::optional<VoltageRange> range;  ///< empty: the narrowest of the board's ranges that suffices
};

struct MacroChannel {
    ChannelChoice output;
    bool reversed = false;  ///< a positive voltage drives the carriage towards lower positions
    /// A digital line for the direction, high for a positive command. The analogue output then carries the
    /// absolute value only.
    std::optional<ChannelChoice> direction;
};

/// A counter input; or, with mm_per_V, an analogue input whose voltage is proportional to the position.
struct EncoderChannel {
    ChannelChoice input;
    bool reversed = false;  ///< counts fall where the position rises
    std::optional<double> mm_per_V;
};

struct ChannelMap {
    MacroChannel macro;
    ChannelChoice micro;  ///< control voltage of the wire's heater driver
    ChannelChoice hall;
    EncoderChannel encoder;
};

}  // namespace fidservo::control::comedi
