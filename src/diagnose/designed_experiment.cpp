// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/designed_experiment.h"

#include "core/rig.h"
#include "src/diagnose/words.h"
#include "src/process/interrupt.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

constexpr double search_share = 0.8;

std::string experiment_name(const std::filesystem::path& file) {
    constexpr std::size_t longest = 60;
    std::string name = file.stem().string().substr(0, longest);
    for (char& letter : name) {
        const auto plain = static_cast<unsigned char>(letter);
        if (plain > 127 || (std::isalnum(plain) == 0 && letter != '-' && letter != '_' && letter != '.'))
            letter = '-';
    }
    return name.empty() ? "designed" : name;
}

std::string quantity_name(design::Quantity quantity) {
    switch (quantity) {
        case design::Quantity::velocity:
            return "velocity";
        case design::Quantity::position:
            return "position";
        case design::Quantity::macro_command:
            return "motor command";
        case design::Quantity::temperature:
            return "temperature";
        case design::Quantity::contraction:
            return "contraction";
    }
    return "";
}

std::vector<std::string> readable_names(const std::vector<std::string>& names) {
    std::vector<std::string> words;
    words.reserve(names.size());
    for (const std::string& name : names)
        words.push_back(name == "equation" ? "the equation" : readable(name));
    return words;
}

/// Of the duels that some experiment decides, the worst; 0 where there is none.
double worst_log_odds(const DesignedNext& next) {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < next.decidable.size(); ++k)
        if (next.decidable[k]) worst = std::min(worst, next.candidate.judgement.log_odds[k]);
    return std::isfinite(worst) ? worst : 0.0;
}

/// What it is for, without an end.
std::string purpose(const DesignedNext& next) {
    std::string text;
    if (!next.candidate.judgement.log_odds.empty()) {
        text = fmt::format("in the simulator it tells {} apart, with odds of {} where that is hardest",
                           enumerated(readable_names(next.question.separates)),
                           odds_words(worst_log_odds(next)));
    }
    if (next.question.unknown) {
        std::vector<std::string> quantities;
        for (const design::Quantity quantity : next.question.unknown->depends_on)
            quantities.push_back(quantity_name(quantity));
        text +=
            fmt::format("{}it goes through all that the rig can do in {}, for what no known effect explains",
                        text.empty() ? "" : "; ", enumerated(quantities));
    }
    return text;
}

}  // namespace

std::string odds_words(double log_odds) {
    constexpr double million = 1e6;
    const double odds = std::exp(std::max(0.0, log_odds));
    if (odds > million) return "more than a million to 1";
    const double step = std::pow(10.0, std::floor(std::log10(odds)));
    return fmt::format("about {:.0f} to 1", std::round(odds / step) * step);
}

DesignAnswer design_next(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                         const DesignRequest& request, const design::Tell& tell) {
    if (diagnosis.ended == gap::Ended::interrupted) return {nullptr, "the diagnosis was interrupted"};
    auto next = std::make_shared<DesignedNext>();
    next->file = request.file;
    next->name = experiment_name(request.file);
    const auto budget = std::make_shared<const gap::Budget>(search_share * request.limit_s, request.limit_s,
                                                            interrupt_requested);
    design::DesignedExperiment designed;
    try {
        tell("what the recordings leave open");
        next->question = design::open_question(evidence, diagnosis);
        if (!next->question.is_open())
            return {nullptr, "nothing is tied, and nothing is left that no known effect explains"};
        const design::Judge judge(evidence.rig(), next->question, request.wire_limit_degC, budget);
        designed = design::design_experiment(judge, next->name, budget, request.effort, tell);
    } catch (const gap::BudgetEnded& end) {
        designed.ended = end.how();
    }
    next->ended = designed.ended;
    if (!designed.best)
        return {nullptr, designed.ended == gap::Ended::interrupted ? "interrupted before any was found"
                         : designed.ended == gap::Ended::budget    ? "the time was over before any was found"
                                                                   : "the rig can do none"};
    next->candidate = std::move(*designed.best);
    next->decidable = designed.decidable;
    if (next->candidate.judgement.value < design::least_log_odds)
        return {nullptr, fmt::format("none of {:g} s that was tried would decide: odds of {} at best",
                                     design::longest_s, odds_words(next->candidate.judgement.value))};
    return {std::move(next), ""};
}

std::string file_text(const DesignedNext& next) {
    std::vector<std::string> remark{"Designed by fidservo diagnose --write-experiment.",
                                    capitalised(purpose(next)) + "."};
    if (next.ended != gap::Ended::finished)
        remark.push_back(next.ended == gap::Ended::interrupted
                             ? "The search for it was interrupted: the best until then."
                             : "The time for the search was over: the best until then.");
    return design::experiment_yaml(next.candidate.design, next.name, remark);
}

gap::ProposedExperiment proposal_of(const DesignedNext& next) {
    gap::ProposedExperiment proposed{next.file.string(), next.question.separates, {}};
    proposed.text = fmt::format("Record {} ({:.3g} s): {}.{}", next.file.string(),
                                design::duration_s(next.candidate.design), purpose(next),
                                next.ended == gap::Ended::interrupted
                                    ? " The search for it was interrupted: it is the best until then."
                                    : "");
    return proposed;
}

}  // namespace fidservo::diagnose
