// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A command that is delayed by any time, not only by whole ticks: what was given at t acts from t + delay on,
// which may be within a tick. Before the first command acts, 0 is in force.
#include "core/demand.h"
#include "core/time.h"

#include <cmath>
#include <vector>

namespace fidservo::plant {

struct DelayLineState {
    struct Change {
        TimeNs given_ns;
        double command;
    };
    std::vector<Change> pending;  ///< changes still to act, as a ring buffer; its size is fixed at the start
    std::size_t first = 0, count = 0;
    double given = 0.0;   ///< the last command given
    double acting = 0.0;  ///< the command in force
    TimeNs now_ns = 0;
};

/// A line whose commands have been 0 so far. It has room for a change of the command at every tick.
inline DelayLineState start_delay_line(double delay_s, double tick_s) {
    constexpr std::size_t spare = 4;  // ticks may be cut short at a frame's time, twice at most
    DelayLineState state;
    state.pending.resize(static_cast<std::size_t>(std::ceil(delay_s / tick_s)) + spare);
    return state;
}

/// Gives a command that is held over a tick, and calls piece(command, duration_s) for each piece of the tick
/// with a constant command in force, in order. Does not allocate.
template <class Piece>
void pass(DelayLineState& state, double delay_s, double tick_s, double command, Piece piece) {
    const std::size_t size = state.pending.size();
    if (command != state.given) {
        FIDSERVO_DEMAND(state.count < size);
        state.pending[(state.first + state.count++) % size] = {state.now_ns, command};
        state.given = command;
    }
    double done_s = 0.0;
    while (state.count > 0) {
        const DelayLineState::Change& next = state.pending[state.first];
        const double acts_s = seconds(next.given_ns - state.now_ns) + delay_s;
        if (acts_s >= tick_s) break;
        if (acts_s > done_s) {
            piece(state.acting, acts_s - done_s);
            done_s = acts_s;
        }
        state.acting = next.command;
        state.first = (state.first + 1) % size;
        --state.count;
    }
    piece(state.acting, tick_s - done_s);
    state.now_ns += nanoseconds(tick_s);
}

}  // namespace fidservo::plant
