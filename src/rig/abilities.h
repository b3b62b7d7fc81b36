// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which commands can be used with a rig, by the parts that its file describes.
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

struct Ability {
    std::string command;
    /// Missing keys of the rig file, or other requirements; empty if the command can be used.
    std::string missing;
};

/// @param has_board  whether the file states how a stage is wired to a board (stage.comedi)
std::vector<Ability> abilities_of(const Rig& rig, bool has_board);

}  // namespace fidservo
