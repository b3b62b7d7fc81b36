// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/undecided.h"

#include "core/parallel.h"
#include "core/rig.h"
#include "gap/candidates/coupling.h"
#include "gap/evidence/halves.h"
#include "gap/evidence/plate_tag.h"
#include "gap/fit/gap_size.h"
#include "gap/links/carriage_run.h"
#include "gap/numbers.h"
#include "gap/search/worth.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

using Lines = std::vector<std::string>;

void add_other_rigs(const Evidence& evidence, Lines& lines) {
    std::map<std::string, int> recordings;
    for (const Recording& recording : evidence.recordings())
        if (!recording.rig.empty() && recording.rig != evidence.rig().name) ++recordings[recording.rig];
    for (const auto& [rig, count] : recordings)
        lines.push_back(
            fmt::format("{} of {} recordings say that they are of the rig \"{}\"; the rig file is of \"{}\"",
                        count, evidence.recordings().size(), rig, evidence.rig().name));
}

/// Mean square of a reading about its mean in a window, floors^2.
std::optional<double> motion_square(const Evidence& evidence, const Window& window) {
    const Recording& recording = evidence.recordings()[window.run];
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t k = window.first_row; k < window.first_row + window.rows; ++k) {
        const StageRow& row = recording.rows[k];
        const double reading =
            window.signal == Signal::hall ? row.hall_adc : reading_count(row, evidence.rig().macro);
        if (std::isnan(reading)) continue;
        sum += reading;
        squares += reading * reading;
        count += 1.0;
    }
    if (count == 0.0) return {};
    const double floor = evidence.floor(window.signal);
    return std::max(0.0, squares / count - sum * sum / (count * count)) / (floor * floor);
}

void add_useless_predictions(const Evidence& evidence, const Selection& selection, Lines& lines) {
    const std::vector<double>& left = selection.steps.back().mean_squares;
    for (const Signal signal : {Signal::encoder, Signal::hall}) {
        double predicted = 0.0, standing = 0.0, count = 0.0;
        for (std::size_t w = 0; w < left.size(); ++w) {
            const Window& window = evidence.windows()[w];
            if (window.signal != signal || std::isnan(left[w])) continue;
            predicted += left[w];
            standing += motion_square(evidence, window).value_or(0.0);
            count += 1.0;
        }
        if (count == 0.0 || predicted < standing || predicted < clearly_off_square * count) continue;
        const double unit = evidence.floor(signal);
        lines.push_back(fmt::format(
            "{}: the simulator predicts it worse ({:.3g} {} r.m.s.) than \"it stays where it is\" would "
            "({:.3g}): is this the rig file of these recordings?",
            name_of(signal), unit * std::sqrt(predicted / count), unit_of(signal),
            unit * std::sqrt(standing / count)));
    }
}

void add_missing_signals(const Evidence& evidence, Lines& lines) {
    const auto say = [&](Signal signal, bool has, std::string_view blocks) {
        const bool is_judged =
            std::ranges::find(evidence.windows(), signal, &Window::signal) != evidence.windows().end();
        if (has && !is_judged)
            lines.push_back(fmt::format("{}: nothing was recorded that can be judged: {} cannot be decided",
                                        name_of(signal), blocks));
    };
    const Rig& rig = evidence.rig();
    say(Signal::encoder, true, "drive, friction, mechanics and encoder of the macro stage");
    say(Signal::hall, rig.micro.has_value(), "heater, wire, platform and Hall sensor");
    const bool has_tags = std::ranges::any_of(
        evidence.recordings(), [&](const Recording& recording) { return shows_tags(recording, rig); });
    say(Signal::tag, has_tags, "camera and plate, and what only they tell of the sensors");
}

void add_unknown_places(const Evidence& evidence, Lines& lines) {
    if (knows_places(evidence)) return;
    Lines effects, recordings;
    for (const plant::Effect* effect : plant::effect_catalogue())
        if (effect->needs_place) effects.emplace_back(effect->name);
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
        if (!evidence.knows_places(run)) recordings.push_back(evidence.recordings()[run].name);
    lines.push_back(fmt::format(
        "{}: not determined: they act at a place on the rail, and where the carriage is in {} is not known: "
        "neither encoder_zero nor a tag of the plate tells, and counts from the end of travel would lie "
        "beyond "
        "it",
        fmt::join(effects, ", "),
        recordings.size() == 1
            ? recordings.front()
            : fmt::format("{} of {} recordings", recordings.size(), evidence.recordings().size())));
}

/// Windows in which effects are looked for, and what the rig file predicts there.
struct GlanceAtWindows {
    Wanted wanted;
    Errors errors;
};

GlanceAtWindows look_at(const Evidence& evidence, const CrossFit& nothing, std::size_t windows_of_a_signal) {
    GlanceAtWindows look{
        instructive(evidence.windows(), everything(evidence), nothing.mean_squares, windows_of_a_signal), {}};
    look.errors = evidence.errors({}, look.wanted);
    return look;
}

/// The loss that an effect would make, by the change of the predictions.
double loss_of(const Evidence& evidence, const GlanceAtWindows& look, const Wanted& wanted,
               const plant::EffectSetting& effect) {
    Errors difference = evidence.errors({effect}, wanted);
    if (difference.empty()) return 0.0;
    for (std::size_t k = 0; k < difference.size(); ++k) difference[k] -= look.errors[k];
    return total_loss(evidence.windows(), wanted, difference);
}

bool would_show(const Evidence& evidence, const Candidate& candidate, const GlanceAtWindows& look) {
    const Wanted wanted = only_of(evidence.windows(), look.wanted, reached_by({{candidate.effect, {}}}));
    return std::ranges::any_of(candidate.shapes, [&](const std::vector<double>& shape) {
        return loss_of(evidence, look, wanted, {candidate.effect, shape}) > least_worth;
    });
}

void add_what_would_not_show(std::span<const Candidate* const> hidden, Lines& lines) {
    std::map<std::string, Lines> by_block;
    for (const Candidate* candidate : hidden)
        by_block[std::string(candidate->effect->block)].emplace_back(candidate->effect->name);
    for (const auto& [block, effects] : by_block)
        lines.push_back(
            fmt::format("{}: {} of typical size would not show in these recordings, which excite "
                        "too little of it",
                        block, fmt::join(effects, ", ")));
}

void add_omissions(const Evidence& evidence, Lines& lines) {
    std::map<std::pair<std::string, std::string>, std::vector<const Omission*>> by_reason;
    for (const Omission& omission : evidence.omissions())
        by_reason[{omission.signal, omission.why}].push_back(&omission);
    for (const auto& [reason, omissions] : by_reason) {
        const auto& [signal, why] = reason;
        double left_out_s = 0.0, recorded_s = 0.0;
        for (const Omission* omission : omissions) {
            left_out_s += omission->left_out_s;
            recorded_s += omission->recorded_s;
        }
        const std::string where = omissions.size() == 1 ? omissions.front()->recording
                                                        : fmt::format("{} recordings", omissions.size());
        lines.push_back(recorded_s == 0.0 ? fmt::format("{}: {}: {}", where, signal, why)
                                          : fmt::format("{}: {}: {:.1f} s of {:.1f} s are not judged: {}",
                                                        where, signal, left_out_s, recorded_s, why));
    }
}

}  // namespace

std::vector<const Candidate*> hidden_candidates(const Evidence& evidence, std::span<const Candidate> tried,
                                                const Selection& selection) {
    std::vector<const Candidate*> hidden;
    for (const Candidate& candidate : tried)
        if (!candidate.is_limit) hidden.push_back(&candidate);
    constexpr std::array<std::size_t, 3> glances{4, 12, 48};
    for (const std::size_t windows_of_a_signal : glances) {  // most show in the first few
        const GlanceAtWindows look = look_at(evidence, selection.steps.front(), windows_of_a_signal);
        std::vector<std::uint8_t> shows(hidden.size());
        parallel_for(hidden.size(),
                     [&](std::size_t k) { shows[k] = would_show(evidence, *hidden[k], look) ? 1 : 0; });
        std::size_t next = 0;
        std::erase_if(hidden, [&](const Candidate*) { return shows[next++] != 0; });
        if (hidden.empty()) break;
    }
    return hidden;
}

std::vector<std::string> undecided(const Evidence& evidence, std::span<const Candidate* const> hidden,
                                   const Selection& selection) {
    Lines lines;
    add_other_rigs(evidence, lines);
    add_useless_predictions(evidence, selection, lines);
    add_missing_signals(evidence, lines);
    add_unknown_places(evidence, lines);
    if (selection.ended != Ended::finished)
        lines.emplace_back(
            "the search was ended before all that might do better was tried: what stays off its floor is the "
            "harder to explain the more effects there are; --effects with those suspected searches among "
            "these");
    add_what_would_not_show(hidden, lines);
    add_omissions(evidence, lines);
    return lines;
}

std::string what_is_wanting(const Evidence& evidence, const Selection& selection) {
    constexpr double least_removed = larger_part;
    constexpr std::ptrdiff_t few_windows = 20;
    const CrossFit& nothing = selection.steps.front();
    const std::vector<SignalGap> gaps = signal_gaps(evidence, nothing.mean_squares, nothing.mean_squares);
    const Signal furthest = std::ranges::max_element(gaps, {}, [](const SignalGap& gap) {
                                return gap.before / gap.floor;
                            })->signal;
    const auto windows = std::ranges::count(evidence.windows(), furthest, &Window::signal);
    const Trial* best = nullptr;
    double most = least_removed;
    for (const Trial& trial : selection.alone) {
        if (!trial.is_leader) continue;
        const double removed =
            total_gap(signal_gaps(evidence, nothing.mean_squares, trial.fitted.mean_squares)).removed();
        if (removed <= most) continue;
        most = removed;
        best = &trial;
    }
    if (best == nullptr)
        return windows >= few_windows ? std::string()
                                      : fmt::format("{}: {} windows are too few to tell a cause from chance",
                                                    name_of(furthest), windows);
    const plant::EffectSetting &one = best->fitted.of_half[0].back(), &other = best->fitted.of_half[1].back();
    std::vector<std::string> values;
    for (std::size_t k = 0; k < one.values.size(); ++k)
        values.push_back(fmt::format("{} {:.3g} by one half of the data, {:.3g} by the other",
                                     one.effect->parameters[k].name, one.values[k], other.values[k]));
    return fmt::format(
        "{} ({}) would remove {:.0f} % of the gap, but {} windows of the {} are too few, or too few of them "
        "say so, to be sure",
        one.effect->name, fmt::join(values, "; "), percent * most, windows, name_of(furthest));
}

}  // namespace fidservo::gap
