// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/coupling.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

SignalFlags flags_of(std::span<const Signal> signals) {
    SignalFlags flags{};
    for (const Signal signal : signals) flags[index_of(signal)] = true;
    return flags;
}

Places coupled_through(const Hypothesis& hypothesis, SignalFlags signals) {
    std::vector<bool> taken(hypothesis.size(), false);
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t k = 0; k < hypothesis.size(); ++k) {
            const SignalFlags own = teachers_of(*hypothesis[k].effect);
            if (taken[k] || !meet(own, signals)) continue;
            taken[k] = grows = true;
            signals = either(signals, own);
        }
    }
    Places places;
    for (std::size_t k = 0; k < taken.size(); ++k)
        if (taken[k]) places.push_back(k);
    return places;
}

}  // namespace

bool moves_carriage(const plant::Effect& effect) {
    return effect.part == plant::Part::carriage || effect.part == plant::Part::encoder;
}

bool has_effect(const Hypothesis& hypothesis, const plant::Effect& effect) {
    return std::ranges::find(hypothesis, &effect, &plant::EffectSetting::effect) != hypothesis.end();
}

Hypothesis moving_carriage(Hypothesis hypothesis) {
    std::erase_if(hypothesis,
                  [](const plant::EffectSetting& setting) { return !moves_carriage(*setting.effect); });
    return hypothesis;
}

SignalFlags only(Signal signal) {
    SignalFlags flags{};
    flags[index_of(signal)] = true;
    return flags;
}

SignalFlags teachers_of(const plant::Effect& effect) {
    SignalFlags teach = flags_of(reach_of(effect));
    if (effect.part == plant::Part::carriage) teach[index_of(Signal::tag)] = false;
    if (teach[index_of(Signal::image)]) teach[index_of(Signal::tag)] = false;
    return teach;
}

SignalFlags taught_by(const Hypothesis& part) {
    SignalFlags teach{};
    for (const plant::EffectSetting& setting : part) teach = either(teach, teachers_of(*setting.effect));
    return teach;
}

SignalFlags reached_by(const Hypothesis& part) {
    SignalFlags reached{};
    for (const plant::EffectSetting& setting : part)
        reached = either(reached, flags_of(reach_of(*setting.effect)));
    return reached;
}

SignalFlags both(const SignalFlags& left, const SignalFlags& right) {
    SignalFlags both{};
    for (std::size_t s = 0; s < signal_count; ++s) both[s] = left[s] && right[s];
    return both;
}

SignalFlags either(const SignalFlags& left, const SignalFlags& right) {
    SignalFlags both{};
    for (std::size_t s = 0; s < signal_count; ++s) both[s] = left[s] || right[s];
    return both;
}

bool meet(const SignalFlags& left, const SignalFlags& right) {
    for (std::size_t s = 0; s < signal_count; ++s)
        if (left[s] && right[s]) return true;
    return false;
}

Wanted only_of(std::span<const Window> windows, Wanted wanted, const SignalFlags& signals) {
    for (std::size_t w = 0; w < wanted.size(); ++w)
        if (!signals[index_of(windows[w].signal)]) wanted[w] = 0;
    return wanted;
}

Places coupled_with(const Hypothesis& hypothesis, const plant::Effect& effect) {
    return coupled_through(hypothesis, teachers_of(effect));
}

std::vector<Places> uncoupled_parts(const Hypothesis& hypothesis) {
    std::vector<Places> parts;
    for (const plant::EffectSetting& setting : hypothesis) {
        Places part = coupled_with(hypothesis, *setting.effect);
        if (std::ranges::find(parts, part) == parts.end()) parts.push_back(std::move(part));
    }
    return parts;
}

Hypothesis part_of(const Hypothesis& hypothesis, const Places& places) {
    Hypothesis part;
    for (const std::size_t place : places) part.push_back(hypothesis[place]);
    return part;
}

Hypothesis with_part(Hypothesis hypothesis, const Places& places,
                     std::span<const plant::EffectSetting> part) {
    for (std::size_t k = 0; k < places.size(); ++k) hypothesis[places[k]] = part[k];
    return hypothesis;
}

Hypothesis extended(Hypothesis hypothesis, const Places& places, const Hypothesis& part) {
    Hypothesis whole = with_part(std::move(hypothesis), places, part);
    whole.push_back(part.back());
    return whole;
}

}  // namespace fidservo::gap
