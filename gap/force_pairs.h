#pragma once
// Which two effects of a carriage balance its forces best.
#include "gap/candidate.h"
#include "gap/force_balance.h"
#include "gap/period_search.h"

#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

struct ForcePair {
    const Candidate *first, *second;
    Hypothesis settings;     ///< of the two
    double loss;             ///< of their balance, as in gap/score.h
    bool needs_both = true;  ///< whether each takes away a good part of what the other leaves alone
    /// Of the two that which balances best alone, fitted alone; none where that leaves as good as all.
    std::optional<plant::EffectSetting> lone{};
    /// With several values of those parameters that it does not depend on.
    std::vector<Hypothesis> starts{};
};

/// Least squares of all pairs over the candidates' shapes, windows weighted as in gap/score.h; from there the
/// best are fitted to the balance in all their parameters, and in those that an effect may be without.
/// @param base     what is known of the rig
/// @param periods  of waves, where a candidate is one
/// @return at most four, none of the same two candidates as another; best first; of those that take away a
/// good part of
///         what the forces lack
std::vector<ForcePair> strongest_force_pairs(const Evidence& evidence, const Wanted& wanted,
                                             const Hypothesis& base,
                                             std::span<const Candidate* const> candidates,
                                             std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
