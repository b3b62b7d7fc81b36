// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What each command can do with a rig: by the parts that its file describes.
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

struct Ability {
    std::string command;
    std::string missing;  ///< keys of the rig file, or what else the command needs; empty if it can be done
};

/// @param has_board  whether the file says how a stage is wired to a board (stage.comedi)
std::vector<Ability> abilities_of(const Rig& rig, bool has_board);

}  // namespace fidservo
