// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/unexplained.h"

#include "core/median.h"
#include "gap/fit/gap_size.h"
#include "src/diagnose/words.h"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

using diagnose::floors_words;

/// "macro.friction" most often: a block that half of the units or more accuse; empty: there is none.
std::string block_of_most(const Unexplained& unexplained) {
    std::map<std::string, std::size_t> votes;
    for (const LeftOver& left : unexplained.units) votes[left.block] += 1;
    for (const auto& [block, count] : votes)
        if (!block.empty() && 2 * count >= unexplained.units.size()) return block;
    return {};
}

}  // namespace

bool Unexplained::is_of_all() const {
    return diagnosed > 1 && 10 * units.size() >= 8 * diagnosed;
}

double Unexplained::median_floors() const {
    std::vector<double> floors;
    for (const LeftOver& left : units) floors.push_back(left.floors);
    return median_of(floors);
}

Unexplained unexplained_of(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units) {
    Unexplained unexplained;
    for (std::size_t u = 0; u < units.size(); ++u) {
        const std::vector<std::size_t>& of_unit = units[u].results;
        if (!results[of_unit.back()].done) unexplained.not_diagnosed.push_back(u);
        const auto last_done =
            std::find_if(of_unit.rbegin(), of_unit.rend(), [&](std::size_t r) { return results[r].done; });
        if (last_done == of_unit.rend()) continue;
        const FleetResult& last = results[*last_done];
        unexplained.diagnosed += 1;
        const bool says_so = last.verdict == "unexplained" || last.verdict == "partly-explained";
        if (!says_so || !(last.gap_after > gap::least_floors)) continue;
        unexplained.units.push_back({.unit = u,
                                     .floors = last.gap_after,
                                     .before = last.gap_before,
                                     .block = last.unexplained,
                                     .campaign = last.campaign,
                                     .was_ended = last.ended != "finished"});
    }
    std::ranges::stable_sort(unexplained.units, std::greater{}, &LeftOver::floors);
    return unexplained;
}

std::string not_diagnosed_sentence(const Unexplained& unexplained, const std::vector<UnitHistory>& units) {
    constexpr std::size_t shown = 6;
    const std::size_t count = unexplained.not_diagnosed.size();
    if (count == 0) return {};
    std::vector<std::string> names;
    for (std::size_t k = 0; k < std::min(count, shown); ++k)
        names.push_back(units[unexplained.not_diagnosed[k]].name);
    if (count > shown) names.push_back(fmt::format("{} more", count - shown));
    return fmt::format("{} of {} units could not be diagnosed when {} recorded last: {}.", count,
                       units.size(), count == 1 ? "it was" : "they were", diagnose::enumerated(names));
}

std::string unexplained_sentence(const Unexplained& unexplained) {
    const std::size_t count = unexplained.units.size();
    const double most = unexplained.units.front().floors;
    const std::string size = count == 1
                                 ? fmt::format("a gap of {} floors", floors_words(most))
                                 : fmt::format("gaps of up to {} floors (half of them {} or more)",
                                               floors_words(most), floors_words(unexplained.median_floors()));
    return fmt::format("{} of {} units {} {} that nothing known explains.", count, unexplained.diagnosed,
                       count == 1 ? "has" : "have", size);
}

std::string unexplained_title(const Unexplained& unexplained, const std::vector<UnitHistory>& units) {
    if (unexplained.is_of_all()) return "All of them: a gap that nothing known explains";
    if (unexplained.units.size() == 1)
        return fmt::format("Unit {}: a gap that nothing known explains",
                           units[unexplained.units.front().unit].name);
    return fmt::format("{} units: gaps that nothing known explains", unexplained.units.size());
}

std::vector<std::string> unexplained_lines(const Unexplained& unexplained,
                                           const std::vector<UnitHistory>& units, std::size_t most) {
    std::vector<std::string> lines;
    for (const LeftOver& left : unexplained.units) {
        if (lines.size() == most) {
            lines.push_back(fmt::format("{} more, with less", unexplained.units.size() - most));
            break;
        }
        std::string line = fmt::format("{}: {} floors are left of {}", units[left.unit].name,
                                       floors_words(left.floors), floors_words(left.before));
        if (!left.block.empty()) line += fmt::format("; it arises in {}", diagnose::block_words(left.block));
        if (left.was_ended) line += "; the search was ended before it had tried everything";
        lines.push_back(line + fmt::format(" ({})", left.campaign));
    }
    return lines;
}

std::vector<std::string> what_to_do(const Unexplained& unexplained) {
    std::vector<std::string> steps;
    const std::string example = unexplained.units.front().campaign;
    if (unexplained.is_of_all())
        steps.emplace_back(
            "Do not trust the simulator for these units yet. What all of them share is in the model or in "
            "the rig "
            "file: compare the rig file with one machine, number by number (fidservo rig check says what "
            "each is "
            "for).");
    else
        steps.emplace_back(
            "Do not trust the simulator for these units yet. Compare them with one that is explained: parts, "
            "place, "
            "wiring, who adjusted them.");
    if (const std::string block = block_of_most(unexplained); !block.empty())
        steps.push_back(
            fmt::format("Begin at {}: there most of them point to.", diagnose::block_words(block)));
    steps.push_back(
        fmt::format("Look at what is left of the worst: fidservo diagnose --rig RIG.yaml {} --report "
                    "left.html shows on what it "
                    "depends, and proposes an equation and the next experiment.",
                    example));
    steps.emplace_back(
        "Where a campaign has few kinds of experiments, record a whole one (fidservo record campaign): what "
        "one "
        "experiment cannot tell apart is not named.");
    if (std::ranges::any_of(unexplained.units, &LeftOver::was_ended))
        steps.emplace_back("Some searches were ended early: diagnose again with a larger --effort.");
    return steps;
}

}  // namespace fidservo::fleet
