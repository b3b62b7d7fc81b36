// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Statistics of a self-check's outcomes.
#include "src/selfcheck/tally/binomial.h"
#include "src/selfcheck/tally/outcome.h"
#include "src/selfcheck/tally/reliability.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// Least size, in floors (Score::floors), at which an effect is expected to be found.
inline constexpr double judged_floors = 3.0;

/// A fraction of cases, with its required value.
struct ShareFigure {
    std::string name;  ///< one word, for the JSON file
    std::string text;
    Share share;
    std::optional<double> at_least;
};

/// A number with its upper limit.
struct LimitFigure {
    std::string name;
    std::string text;
    double value;
    std::optional<double> at_most;
};

/// Cases with one effect, by its class.
struct ClassRow {
    std::string class_name;
    Share right;  ///< named first, for sizes of at least judged_floors
    Share right_at_any_size;
    /// Number of cases for each class named first, or "nothing"; any size.
    std::map<std::string, std::size_t> named;
};

/// Cases with one effect, by size.
struct PowerRow {
    double from_floors, to_floors;
    Share found;  ///< the verdict is not no-gap
    Share right;  ///< named first
};

struct Tally {
    std::size_t cases = 0;
    std::vector<ShareFigure> shares;
    std::vector<LimitFigure> limits;
    std::vector<ClassRow> classes;
    std::vector<PowerRow> power;
    Reliability reliability;
};

Tally tally(std::span<const Outcome> outcomes);

/// Whether all figures that have a limit are within it. Figures without cases count as within.
bool keeps_all_limits(const Tally& tally);

/// The p-quantile of the values; NaN without values.
double quantile(std::vector<double> values, double p);

}  // namespace fidservo::selfcheck
