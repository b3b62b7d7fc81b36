// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/judgement_words.h"

#include "src/diagnose/advice.h"
#include "src/diagnose/words.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

using diagnose::three_digits;

const Quantity& quantity_of(const FleetFindings& findings, const Judgement& judgement) {
    return findings.quantities[judgement.quantity].quantity;
}

std::string cause_of(const Quantity& quantity) {
    const diagnose::Advice* advice = diagnose::advice_on(quantity.effect);
    return advice == nullptr ? "there is " + diagnose::readable(quantity.effect) : std::string(advice->what);
}

std::string with_unit(std::string text, const Quantity& quantity) {
    return quantity.unit.empty() ? text : text + " " + quantity.unit;
}

/// Half of the width of an interval of 95 %.
double half_width(const Level& level) {
    return 1.96 * level.std;
}

std::string since_words(const Judgement& judgement) {
    const Dates& since = *judgement.since;
    return fmt::format("{} (95 %: after {}, by {})", date_of(since.likeliest_s), date_of(since.earliest_s),
                       date_of(since.latest_s));
}

std::string ratio_words(double log_ratio) {
    return fmt::format("10^{:.0f}", std::clamp(log_ratio / std::numbers::ln10, -999.0, 999.0));
}

}  // namespace

std::string_view name_of(Whose whose) {
    return whose == Whose::all ? "all" : whose == Whose::group ? "group" : "unit";
}

std::string_view name_of(Matter matter) {
    return matter == Matter::deviation ? "deviation" : matter == Matter::step ? "step" : "trend";
}

std::string value_words(const Quantity& quantity, double floors) {
    return with_unit(three_digits(quantity.in_units(floors)), quantity);
}

std::string change_words(const Quantity& quantity, double floors) {
    const double change = floors / quantity.floors_per_unit;
    return with_unit((change < 0.0 ? "" : "+") + three_digits(change), quantity);
}

std::string unit_names(const FleetFindings& findings, const std::vector<std::size_t>& units,
                       std::size_t most) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < std::min(units.size(), most); ++k)
        names.push_back(findings.units[units[k]].name);
    if (units.size() > most) names.push_back(fmt::format("{} more", units.size() - most));
    return diagnose::enumerated(names);
}

std::string whose_words(const FleetFindings& findings, const Judgement& judgement) {
    const std::size_t units = findings.quantities[judgement.quantity].units.size();
    switch (judgement.whose) {
        case Whose::all:
            if (judgement.matter == Matter::deviation) return "All of them: the model is wrong";
            if (judgement.units.size() == units) return "All units";
            return fmt::format("{} of {} units, since the same date", judgement.units.size(), units);
        case Whose::group:
            return judgement.group.empty()
                       ? fmt::format("{} units, since the same date", judgement.units.size())
                       : diagnose::capitalised(judgement.group);
        case Whose::unit:
            break;
    }
    return "Unit " + unit_names(findings, judgement.units);
}

std::string nothing_stands_out(const FleetFindings& findings) {
    constexpr std::size_t fewest = 3;
    if (findings.unexplained.diagnosed == 0) return "Nothing was diagnosed.";
    std::vector<std::string> named;
    for (const QuantityFindings& found : findings.quantities)
        for (const UnitFindings& unit : found.units)
            if (unit.known.named() && std::abs(unit.known.value) > half_width(unit.known))
                named.push_back(fmt::format("{} of {} ({})", diagnose::readable(found.quantity.effect),
                                            findings.units[unit.series.unit].name,
                                            value_words(found.quantity, unit.known.value)));
    if (findings.units.size() < fewest && !named.empty())
        return fmt::format(
            "None has changed; diagnoses name {}. Of fewer than three units it cannot be told whether a unit "
            "is "
            "off or the model.",
            diagnose::enumerated(named));
    return findings.unexplained.empty()
               ? "No unit stands out, and none has changed."
               : "By the effects that are named no unit stands out, and none has changed.";
}

std::string matter_sentence(const FleetFindings& findings, const Judgement& judgement) {
    const Quantity& quantity = quantity_of(findings, judgement);
    const std::string cause = diagnose::capitalised(cause_of(quantity));
    const std::string name = diagnose::readable(quantity.parameter);
    switch (judgement.matter) {
        case Matter::trend:
            return fmt::format("{}, and that changes by {} a week ({}) since {}. It now stands at {}.", cause,
                               change_words(quantity, judgement.size.value), name, since_words(judgement),
                               value_words(quantity, judgement.now));
        case Matter::step:
            return fmt::format("{}: {} changed by {} on {}. It now stands at {}.", cause, name,
                               change_words(quantity, judgement.size.value), since_words(judgement),
                               value_words(quantity, judgement.now));
        case Matter::deviation:
            break;
    }
    const std::string than =
        judgement.is_beside_others ? "differs from what the other units have" : "is off the rig file";
    std::string sentence = fmt::format("{}: {} {} by {} \u00b1 {} (95 %), {} floors.", cause, name, than,
                                       change_words(quantity, judgement.size.value),
                                       three_digits(half_width(judgement.size) / quantity.floors_per_unit),
                                       three_digits(std::abs(judgement.size.value)));
    if (judgement.is_beside_others)
        sentence += fmt::format(" It stands at {}; the rig file says {}.",
                                value_words(quantity, judgement.now), value_words(quantity, 0.0));
    if (judgement.is_by_rig_file)
        sentence += fmt::format(
            " {} diagnosed with another rig file than the others, and values count from the "
            "file: it may be the files that differ.",
            judgement.units.size() == 1 ? "It was" : "They were");
    return sentence;
}

std::string evidence_sentences(const FleetFindings& findings, const Judgement& judgement) {
    std::string text;
    if (judgement.matter != Matter::deviation)
        text = fmt::format(
            "Found first with the recordings of {}. All diagnoses together speak for a change {} times more "
            "than an alarm asks "
            "for, which itself is false at most {} times a unit-year.",
            date_of(*judgement.found_s), ratio_words(judgement.log_odds), false_alarms_a_unit_year);
    if (judgement.probability < 1.0 || judgement.log_all != 0.0)
        text += fmt::format(
            "{}Against no deviation the likelihood is {} times larger with one value for all units, {} with "
            "a batch of "
            "its own, {} with one unit of its own; odds {} to 1 with what having looked elsewhere costs, "
            "probability {}.",
            text.empty() ? "" : " ", ratio_words(judgement.log_all), ratio_words(judgement.log_group),
            ratio_words(judgement.log_unit), ratio_words(judgement.log_odds),
            diagnose::probability_words(judgement.probability));
    const QuantityFindings& found = findings.quantities[judgement.quantity];
    text += fmt::format(
        " Units that are alike differ by {} floors, and scatter by {} floors from one diagnosis to the next.",
        three_digits(found.population.spread), three_digits(found.scatter.std));
    return text;
}

std::vector<std::string> what_to_do(const FleetFindings& findings, const Judgement& judgement) {
    const Quantity& quantity = quantity_of(findings, judgement);
    const diagnose::Advice* advice = diagnose::advice_on(quantity.effect);
    const std::string check = advice == nullptr ? "" : std::string(advice->check);
    const std::string cure = advice == nullptr ? "" : std::string(advice->cure);
    std::vector<std::string> steps;
    if (judgement.matter != Matter::deviation)
        steps.push_back(
            fmt::format("Look up what was done to {} between {} and {}: a part exchanged, a screw loosened, "
                        "a move, a new program.",
                        judgement.whose == Whose::unit ? "it" : "them", date_of(judgement.since->earliest_s),
                        date_of(judgement.since->latest_s)));
    if (judgement.matter == Matter::trend)
        steps.push_back(fmt::format("Plan the repair: going on like this it is {} floors off in four weeks.",
                                    three_digits(std::abs(judgement.now + 4.0 * judgement.size.value))));
    if (judgement.whose == Whose::all && judgement.matter == Matter::deviation) {
        steps.push_back("Check it on one unit: " + check);
        steps.push_back(
            fmt::format("If it is so, let the rig file of all units state {} = {}: cured-rig.yaml, beside "
                        "the results, does where --rig is given.",
                        quantity.parameter, value_words(quantity, judgement.size.value)));
        return steps;
    }
    if (judgement.is_by_rig_file)
        steps.emplace_back(
            "Diagnose all units with one rig file (fleet diagnose --rig) and report again, before anything "
            "is "
            "adjusted.");
    if (judgement.is_beside_others && std::abs(judgement.now) < 0.5 * std::abs(judgement.size.value)) {
        steps.emplace_back(
            "Adjust nothing here: it agrees with the rig file where the others do not. Compare it with one "
            "of "
            "them: parts, supplier, place, who adjusted them.");
        return steps;
    }
    steps.push_back(check);
    if (judgement.whose == Whose::group)
        steps.push_back(
            "Compare one of these units with one of the others: parts, supplier, place, who adjusted them.");
    steps.push_back(cure);
    return steps;
}

}  // namespace fidservo::fleet
