// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which commands can be used with a rig, by what its file says.
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

struct Ability {
    std::string command;
    std::string missing;  ///< keys of the rig file; empty if none are
    std::string reason;   ///< why it cannot be used though none are missing; empty if it can

    bool is_possible() const { return missing.empty() && reason.empty(); }
};

/// Experiments to be recorded are simulated with the rig file first (src/record/foresight.h), a few of each
/// kind.
/// @param has_board  whether the file states how a stage is wired to a board (stage.comedi)
std::vector<Ability> abilities_of(const Rig& rig, bool has_board);

}  // namespace fidservo
