// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effects change the same signals. Effects without a signal in common can be fitted separately.
#include "gap/evidence.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

using SignalFlags = std::array<bool, signal_count>;

inline constexpr SignalFlags all_signals{true, true, true, true, true, true};

SignalFlags only(Signal signal);

/// Whether an effect changes the carriage's motion or its encoder's reading.
bool moves_carriage(const plant::Effect& effect);

/// Whether one of a hypothesis' settings is of an effect.
bool has_effect(const Hypothesis& hypothesis, const plant::Effect& effect);

/// The settings of a hypothesis whose effects change the carriage's motion or its encoder's reading.
Hypothesis moving_carriage(Hypothesis hypothesis);

/// Signals from which the parameters of an effect are estimated: those whose prediction it changes directly.
/// What moves the carriage also shows in the tags, but only with what the encoder has already shown; the same
/// holds for a longer exposure, which the image shows.
SignalFlags teachers_of(const plant::Effect& effect);

/// The signals from which all effects of a part of a hypothesis are estimated.
SignalFlags taught_by(const Hypothesis& part);

/// All signals that a part of a hypothesis can change.
SignalFlags reached_by(const Hypothesis& part);

SignalFlags both(const SignalFlags& left, const SignalFlags& right);
SignalFlags either(const SignalFlags& left, const SignalFlags& right);
bool meet(const SignalFlags& left, const SignalFlags& right);

/// The wanted windows that are of these signals.
Wanted only_of(std::span<const Window> windows, Wanted wanted, const SignalFlags& signals);

/// Indices of settings in a hypothesis, ascending.
using Places = std::vector<std::size_t>;

/// The settings with a signal in common with an effect, those with a signal in common with these, and so on.
Places coupled_with(const Hypothesis& hypothesis, const plant::Effect& effect);

/// A hypothesis divided into parts without signals in common.
std::vector<Places> uncoupled_parts(const Hypothesis& hypothesis);

Hypothesis part_of(const Hypothesis& hypothesis, const Places& places);

/// The hypothesis with the settings at some indices replaced.
Hypothesis with_part(Hypothesis hypothesis, const Places& places, std::span<const plant::EffectSetting> part);

/// The same, with the last setting of the part appended as a new one.
Hypothesis extended(Hypothesis hypothesis, const Places& places, const Hypothesis& part);

}  // namespace fidservo::gap
