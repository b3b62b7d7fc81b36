// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/tally_text.h"

#include <cmath>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

/// "97.5 % (88.0 .. 99.6)   39 of 40".
std::string text_of(const Share& share) {
    const Interval interval = wilson_interval(share);
    return fmt::format("{:>5.1f} % ({:>5.1f} .. {:>5.1f}) {:>4} of {:<4}", 100.0 * share.value(),
                       100.0 * interval.low, 100.0 * interval.high, share.hits, share.of);
}

std::string line_of(const ShareFigure& figure) {
    std::string limit;
    if (figure.at_least)
        limit = fmt::format("at least {:g} %{}", 100.0 * *figure.at_least,
                            figure.share.value() < *figure.at_least ? ", MISSED" : "");
    return fmt::format("  {:<70} {}  {}\n", figure.text, text_of(figure.share), limit);
}

std::string line_of(const LimitFigure& figure) {
    std::string limit;
    if (figure.at_most)
        limit =
            fmt::format("at most {:g}{}", *figure.at_most, figure.value > *figure.at_most ? ", MISSED" : "");
    return fmt::format("  {:<70} {:>7.3g} {:>27} {}\n", figure.text, figure.value, "", limit);
}

std::string line_of(const PowerRow& row) {
    const std::string range = std::isinf(row.to_floors)
                                  ? fmt::format("{:g} and more", row.from_floors)
                                  : fmt::format("{:g} .. {:g}", row.from_floors, row.to_floors);
    return fmt::format("  {:<16} {}   {}\n", range, text_of(row.found), text_of(row.right));
}

std::string line_of(const ClassRow& row) {
    std::string named;
    for (const auto& [name, count] : row.named) named += fmt::format("  {} {}", name, count);
    return fmt::format("  {:<22} {:>3} of {:<3} {:>3} of {:<3} {}\n", row.class_name, row.right.hits,
                       row.right.of, row.right_at_any_size.hits, row.right_at_any_size.of, named);
}

}  // namespace

std::string text_of(const Tally& tally) {
    std::string text = fmt::format(
        "\n{} cases; shares with their 95 % intervals; of cases with effects those at {:g} floors or more\n",
        tally.cases, judged_floors);
    for (const ShareFigure& figure : tally.shares)
        if (figure.share.of > 0) text += line_of(figure);
    for (const LimitFigure& figure : tally.limits)
        if (!std::isnan(figure.value)) text += line_of(figure);
    if (!tally.classes.empty())
        text += fmt::format("\none effect, by size\n  {:<16} {:<37} {}\n", "floors", "found",
                            "right effect first");
    for (const PowerRow& row : tally.power)
        if (row.found.of > 0) text += line_of(row);
    if (!tally.reliability.bins.empty()) text += "\nfirst probability: mean, share that was right, cases\n";
    for (const ReliabilityBin& bin : tally.reliability.bins)
        text += fmt::format("  {:.4f}  {:.3f}  {}\n", bin.mean_probability, bin.share_true, bin.claims);
    if (!tally.classes.empty())
        text +=
            fmt::format("\none effect, by class: right first at {:g} floors or more, at any size; named\n",
                        judged_floors);
    for (const ClassRow& row : tally.classes) text += line_of(row);
    return text;
}

}  // namespace fidservo::selfcheck
