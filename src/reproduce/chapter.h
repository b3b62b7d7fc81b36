// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The chapters of the report on the published system: each has figures and claims that they confirm or not.
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::reproduce {

enum class Outcome {
    holds,
    /// The reference rig, completed where the paper gives no number, differs from the paper's in this
    /// respect; `why` explains it.
    rig_differs,
    fails,
};

/// "holds", "the rig differs", "does not hold".
std::string_view name_of(Outcome outcome);

struct Claim {
    std::string source;    ///< place in the publication: "fig. 17", "eq. 9"
    std::string claim;     ///< the publication's claim
    std::string measured;  ///< the result here, with units
    Outcome outcome = Outcome::fails;
    std::string why;  ///< explanation, unless it holds
};

inline Outcome holds_if(bool condition) {
    return condition ? Outcome::holds : Outcome::fails;
}

struct Chapter {
    std::string id;  ///< anchor of its place in the report
    std::string heading;
    std::string html;
    std::vector<Claim> claims;
};

}  // namespace fidservo::reproduce
