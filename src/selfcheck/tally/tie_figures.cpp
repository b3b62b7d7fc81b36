// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/tie_figures.h"

namespace fidservo::selfcheck {

std::vector<ShareFigure> tie_shares(std::span<const Outcome> outcomes) {
    constexpr double to_be = 0.9;
    ShareFigure by_design{"ties_resolved_by_design", "ties: resolved by the designed experiment", {}, to_be},
        by_list{"ties_resolved_by_list", "ties: resolved by the best experiment of the list", {}, {}};
    for (const Outcome& outcome : outcomes) {
        if (!outcome.tie || !outcome.tie->by_design) continue;
        by_design.share.add(outcome.tie->by_design->is_resolved);
        by_list.share.add(outcome.tie->by_list && outcome.tie->by_list->is_resolved);
    }
    return {by_design, by_list};
}

}  // namespace fidservo::selfcheck
