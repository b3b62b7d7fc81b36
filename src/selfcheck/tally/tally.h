// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a self-check's outcomes come to.
#include "src/selfcheck/tally/binomial.h"
#include "src/selfcheck/tally/outcome.h"
#include "src/selfcheck/tally/reliability.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// From this size on, in floors (Score::floors), an effect is asked to be found.
inline constexpr double judged_floors = 3.0;

/// A share of cases, and how large it should be.
struct ShareFigure {
    std::string name;  ///< one word, of the JSON file
    std::string text;
    Share share;
    std::optional<double> at_least;
};

/// A number, and how large it may be.
struct LimitFigure {
    std::string name;
    std::string text;
    double value;
    std::optional<double> at_most;
};

/// Cases with one effect, by its class.
struct ClassRow {
    std::string class_name;
    Share right;  ///< named first, at judged_floors or more
    Share right_at_any_size;
    std::map<std::string, std::size_t> named;  ///< class named first, or "nothing"; any size
};

/// Cases with one effect, by size.
struct PowerRow {
    double from_floors, to_floors;
    Share found;  ///< verdict other than no-gap
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

/// Whether all figures that have a limit keep it; those of no cases do.
bool keeps_all_limits(const Tally& tally);

/// The share p of the values is not above it; NaN of none.
double quantile(std::vector<double> values, double p);

}  // namespace fidservo::selfcheck
