// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effects meet in the same signals. What does not meet an effect is of no concern to its fit.
#include "gap/evidence.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

using SignalFlags = std::array<bool, signal_count>;

inline constexpr SignalFlags all_signals{true, true, true, true, true, true};

SignalFlags only(Signal signal);

/// Whether an effect changes how the carriage moves, or how its encoder says so.
bool moves_carriage(const plant::Effect& effect);

/// Those settings of a hypothesis that do.
Hypothesis moving_carriage(Hypothesis hypothesis);

/// Signals from which the parameters of an effect are learnt: those whose prediction it changes at first
/// hand. What moves the carriage shows in the tags as well, but says there what the encoder has said;
/// so does a longer exposure, which the image tells.
SignalFlags teachers_of(const plant::Effect& effect);

/// Of all effects of a part of a hypothesis.
SignalFlags taught_by(const Hypothesis& part);

/// All signals that a part of a hypothesis can change.
SignalFlags reached_by(const Hypothesis& part);

SignalFlags both(const SignalFlags& left, const SignalFlags& right);
SignalFlags either(const SignalFlags& left, const SignalFlags& right);
bool meet(const SignalFlags& left, const SignalFlags& right);

/// Those of the windows wanted that are of some signals.
Wanted only_of(std::span<const Window> windows, Wanted wanted, const SignalFlags& signals);

/// Places of settings in a hypothesis, ascending.
using Places = std::vector<std::size_t>;

/// Those that an effect meets, that these meet in turn, and so on.
Places coupled_with(const Hypothesis& hypothesis, const plant::Effect& effect);

/// A hypothesis cut into parts that do not meet.
std::vector<Places> uncoupled_parts(const Hypothesis& hypothesis);

Hypothesis part_of(const Hypothesis& hypothesis, const Places& places);

/// The hypothesis with other settings at some places.
Hypothesis with_part(Hypothesis hypothesis, const Places& places, std::span<const plant::EffectSetting> part);

/// The same with the part's last setting as a further one.
Hypothesis extended(Hypothesis hypothesis, const Places& places, const Hypothesis& part);

}  // namespace fidservo::gap
