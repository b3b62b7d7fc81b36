// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/verdict_words.h"

#include "core/rig.h"
#include "src/diagnose/advice.h"
#include "src/diagnose/words.h"

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

std::string what_is(const std::string& effect) {
    const Advice* advice = advice_on(effect);
    return advice != nullptr ? std::string(advice->what) : "of " + readable(effect);
}

/// The clauses of all effects that were found.
std::string causes(const gap::Diagnosis& diagnosis) {
    std::vector<std::string> clauses;
    for (const gap::FoundEffect& effect : diagnosis.effects) clauses.push_back(what_is(effect.effect));
    return enumerated(clauses);
}

std::string remainder_words(const gap::Remainder& remainder) {
    std::string text = "in " + block_words(remainder.block);
    std::vector<std::string> names;
    for (const std::string& name : remainder.depends_on) names.push_back(dependence_words(name));
    if (!names.empty()) text += ", dependent on " + enumerated(names);
    return text;
}

std::string sizes(const gap::Diagnosis& diagnosis) {
    return fmt::format("The simulator's predictions were off by {} noise floors",
                       three_digits(diagnosis.gap.before));
}

std::string ties(const gap::Diagnosis& diagnosis) {
    std::string text;
    for (const gap::FoundEffect& effect : diagnosis.effects) {
        std::vector<std::string> others;
        for (const std::string& name : ties_of(effect, diagnosis)) others.push_back(readable(name));
        if (others.empty()) continue;
        text += fmt::format(" These recordings cannot tell {} from {}.", readable(effect.effect),
                            enumerated(others));
    }
    return text;
}

}  // namespace

std::string end_words(gap::Ended ended) {
    switch (ended) {
        case gap::Ended::budget:
            return "the time was over before all was tried; this is the best until then";
        case gap::Ended::interrupted:
            return "interrupted; this is the best until then";
        case gap::Ended::finished:
            break;
    }
    return "all was tried";
}

namespace {

/// What an equation does; empty where there is none.
std::string equation_words(const gap::Diagnosis& diagnosis) {
    const gap::Equation* equation = gap::proposed_equation(diagnosis);
    if (equation == nullptr) return "";
    return fmt::format(
        " An equation at {} that these recordings propose removes {} of {}.", equation->acts_on,
        share_words(equation->gap_removed),
        equation->in_place_of_names ? "the whole gap, without the effects named" : "what is left");
}

}  // namespace

std::string verdict_sentence(const gap::Diagnosis& diagnosis) {
    if (diagnosis.signals.empty()) return "Nothing in these recordings could be judged.";
    if (const gap::Equation* equation = gap::proposed_equation(diagnosis);
        equation != nullptr && equation->in_place_of_names)
        return "Rig and simulator disagree; an equation that the recordings propose explains it better than "
               "any "
               "known effect.";
    switch (diagnosis.verdict) {
        case gap::Verdict::no_gap:
            return "No gap was found between the rig and its simulator.";
        case gap::Verdict::explained:
            return fmt::format("Rig and simulator disagree because {}.", causes(diagnosis));
        case gap::Verdict::partly_explained:
            return fmt::format(
                "Rig and simulator disagree in part because {}; something that no known effect explains is "
                "left.",
                causes(diagnosis));
        case gap::Verdict::unexplained:
            return diagnosis.unexplained
                       ? fmt::format("Rig and simulator disagree {}; no known effect explains it.",
                                     remainder_words(*diagnosis.unexplained))
                       : "Rig and simulator disagree, and no known effect explains it.";
    }
    return "";
}

std::string verdict_detail(const gap::Diagnosis& diagnosis) {
    if (diagnosis.signals.empty())
        return "They are too short or too incomplete for a comparison with the simulator.";
    switch (diagnosis.verdict) {
        case gap::Verdict::no_gap: {
            if (size_class(diagnosis.gap.before) == 0)
                return fmt::format(
                    "Its predictions are off by {} noise floors, as much as the sensors' noise alone makes "
                    "them, and nothing that was tried predicts better.",
                    three_digits(diagnosis.gap.before));
            return sizes(diagnosis) +
                   ", but nothing that was tried predicts these recordings significantly better; more or "
                   "longer recordings may decide.";
        }
        case gap::Verdict::explained:
        case gap::Verdict::partly_explained: {
            std::string text = fmt::format(
                "{}; with {} they are off by {}: {} of the excess is gone, counted on recordings that were "
                "held out.",
                sizes(diagnosis), diagnosis.effects.size() == 1 ? "this effect" : "these effects",
                three_digits(diagnosis.gap.after), share_words(diagnosis.gap.removed()));
            if (diagnosis.unexplained)
                text += " What is left arises " + remainder_words(*diagnosis.unexplained) + ".";
            else if (size_class(diagnosis.gap.after) > 0)
                text += " What is left is above the noise floor, but without a pattern that could be found.";
            return text + equation_words(diagnosis) + ties(diagnosis);
        }
        case gap::Verdict::unexplained:
            if (diagnosis.unexplained && diagnosis.unexplained->depends_on.empty())
                return sizes(diagnosis) + "; nothing was found that the errors depend on." +
                       equation_words(diagnosis);
            return sizes(diagnosis) +
                   ". A model without a name, fitted to what the errors depend on, predicts the recordings "
                   "better; none of the catalogue's effects does." +
                   equation_words(diagnosis);
    }
    return "";
}

}  // namespace fidservo::diagnose
