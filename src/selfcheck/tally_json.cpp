// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally_json.h"

#include "core/result.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/process/commit.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace fidservo::selfcheck {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    return value;
}

Json json_of(const Share& share) {
    const Interval interval = wilson_interval(share);
    return {{"hits", share.hits},
            {"of", share.of},
            {"share", number(share.value())},
            {"interval", {interval.low, interval.high}}};
}

Json json_of(const TrueEffect& effect) {
    return {{"effect", effect.effect},
            {"class", effect.class_name},
            {"block", effect.block},
            {"formula", effect.formula},
            {"size", number(effect.size)},
            {"expected_floors", number(effect.expected_floors)},
            {"gap_floors", number(effect.gap_floors)}};
}

Json json_of(const NamedEffect& named) {
    return {{"effect", named.effect},
            {"class", named.class_name},
            {"true", named.is_true},
            {"probability", number(named.probability)},
            {"support", support_json(named.support)},
            {"replaced", named.is_replaced},
            {"gap", {{"before", number(named.gap_before)}, {"after", number(named.gap_after)}}}};
}

Json json_of(const std::optional<Settlement>& settlement) {
    if (!settlement) return nullptr;
    return {{"experiment", settlement->experiment},
            {"expected_log_odds", number(settlement->log_odds)},
            {"resolved", settlement->is_resolved},
            {"named", settlement->named}};
}

Json json_of(const Tie& tie) {
    return {{"set", tie.set},
            {"holds_truth", tie.holds_truth},
            {"by_design", json_of(tie.by_design)},
            {"by_list", json_of(tie.by_list)},
            {"design_s", number(tie.design_s)}};
}

Json json_of(const Outcome& outcome) {
    Json effects = Json::array();
    for (const TrueEffect& effect : outcome.label.effects) effects.push_back(json_of(effect));
    const Score& score = outcome.score;
    Json classes = Json::array(), found = Json::array();
    for (const NamedEffect& named : score.named) {
        classes.push_back(named.class_name);
        found.push_back(json_of(named));
    }
    Json json{{"number", outcome.number},
              {"kind", name_of(outcome.label.kind)},
              {"effects", effects},
              {"verdict", gap::name_of(score.verdict)},
              {"floors", number(score.floors)},
              {"gap", {{"before", number(score.before)}, {"after", number(score.after)}}},
              {"removed", number(score.removed)},
              {"floors_left", number(score.floors_left)},
              {"named", classes},
              {"found", found},
              {"first_block", score.first_block},
              {"first_probability", number(score.first_probability)},
              {"set_size", score.set_size},
              {"right_block_first", score.right_block_first},
              {"right_effect_first", score.right_effect_first},
              {"any_right", score.any_right},
              {"truths_named", score.truths_named},
              {"all_right", score.all_right},
              {"confident_wrong", score.is_confident_wrong},
              {"recording_s", number(outcome.recording_s)},
              {"diagnosis_s", number(outcome.diagnosis_s)}};
    if (const auto& discrepancy = outcome.label.discrepancy)
        json["discrepancy"] = {{"block", discrepancy->block},
                               {"depends_on", discrepancy->depends_on},
                               {"size", number(discrepancy->size)},
                               {"gap_floors", number(discrepancy->gap_floors)}};
    if (outcome.tie) json["tie"] = json_of(*outcome.tie);
    if (score.dominant_place) json["dominant_place"] = *score.dominant_place;
    if (const auto& equation = score.equation) {
        const FormulaEffect& truth = *outcome.label.effects.front().as_formula;
        json["equation"] = {{"true_port", truth.acts_on},
                            {"true_formula", truth.formula},
                            {"acts_on", equation->acts_on},
                            {"formula", equation->formula},
                            {"right_variables", equation->right_variables},
                            {"apart", number(equation->apart)},
                            {"removed", number(equation->removed)}};
        if (equation->removed_of_kinds_left_out)
            json["equation"]["removed_of_kinds_left_out"] = number(*equation->removed_of_kinds_left_out);
    }
    if (score.removed_of_true) json["removed_of_true"] = number(*score.removed_of_true);
    return json;
}

Json figures_of(const Tally& tally) {
    Json figures = Json::object();
    for (const ShareFigure& figure : tally.shares) {
        Json json = json_of(figure.share);
        json["text"] = figure.text;
        if (figure.at_least) json["at_least"] = *figure.at_least;
        figures[figure.name] = std::move(json);
    }
    for (const LimitFigure& figure : tally.limits) {
        Json json{{"value", number(figure.value)}, {"text", figure.text}};
        if (figure.at_most) json["at_most"] = *figure.at_most;
        figures[figure.name] = std::move(json);
    }
    return figures;
}

Json options_of(const SelfCheckOptions& options) {
    Json kinds = Json::array();
    for (const CaseKind kind : options.kinds) kinds.push_back(name_of(kind));
    return {{"cases", options.cases},
            {"first", options.first},
            {"seed", options.seed},
            {"kinds", kinds},
            {"only", options.only},
            {"recordings", options.recordings},
            {"settles_ties", options.settles_ties},
            {"by_effort", options.limited == gap::Seconds::by_effort}};
}

}  // namespace

std::string self_check_json(const SelfCheckOptions& options, const SelfCheck& check, const Tally& tally) {
    Json classes = Json::array(), power = Json::array(), bins = Json::array(), cases = Json::array(),
         failures = Json::array();
    for (const ClassRow& row : tally.classes)
        classes.push_back({{"class", row.class_name},
                           {"right", json_of(row.right)},
                           {"right_at_any_size", json_of(row.right_at_any_size)},
                           {"named", row.named}});
    for (const PowerRow& row : tally.power)
        power.push_back({{"from_floors", row.from_floors},
                         {"to_floors", number(row.to_floors)},
                         {"found", json_of(row.found)},
                         {"right", json_of(row.right)}});
    for (const ReliabilityBin& bin : tally.reliability.bins)
        bins.push_back({{"mean_probability", bin.mean_probability},
                        {"share_true", bin.share_true},
                        {"cases", bin.claims}});
    for (const Outcome& outcome : check.outcomes) cases.push_back(json_of(outcome));
    for (const Failure& failure : check.failures)
        failures.push_back({{"number", failure.number}, {"text", failure.text}});
    const Json all{{"format", "fidservo-self-check/1"},
                   {"commit", built_from_commit()},
                   {"options", options_of(options)},
                   {"interrupted", check.finished() < options.cases},
                   {"figures", figures_of(tally)},
                   {"classes", classes},
                   {"power", power},
                   {"reliability", bins},
                   {"failures", failures},
                   {"cases", cases}};
    return all.dump(2) + "\n";
}

}  // namespace fidservo::selfcheck
