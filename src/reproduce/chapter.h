// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the report on the published system is made of: chapters, each with its figures and the claims that
// they decide.
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::reproduce {

enum class Outcome {
    holds,
    rig_differs,  ///< the reference rig, completed where the paper gives no number, is another machine here;
                  ///< `why` says it
    fails,
};

/// "holds", "the rig differs", "does not hold".
std::string_view name_of(Outcome outcome);

struct Claim {
    std::string source;    ///< place in the publication: "fig. 17", "eq. 9"
    std::string claim;     ///< what is claimed
    std::string measured;  ///< what was measured here, with units
    Outcome outcome = Outcome::fails;
    std::string why;  ///< of anything but `holds`
};

inline Outcome holds_if(bool condition) {
    return condition ? Outcome::holds : Outcome::fails;
}

struct Chapter {
    std::string id;  ///< of its place in the report
    std::string heading;
    std::string html;
    std::vector<Claim> claims;
};

}  // namespace fidservo::reproduce
