// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/surrogate.h"

#include <array>

namespace fidservo::gap {

std::string_view name_of(Dependence dependence) {
    constexpr std::array<std::string_view, 34> names{"velocity",
                                                     "direction",
                                                     "position",
                                                     "position, periodic",
                                                     "position, periodic in the reading",
                                                     "acceleration",
                                                     "command",
                                                     "changes of the command",
                                                     "command, periodic",
                                                     "nothing: a constant force",
                                                     "time",
                                                     "temperature",
                                                     "temperature before",
                                                     "turns between the wire's end states",
                                                     "contraction",
                                                     "contraction before",
                                                     "place of the platform",
                                                     "way since the wire turned",
                                                     "macro command",
                                                     "position, against the motion",
                                                     "position, periodic, times the drive's force",
                                                     "way gone so far, against the motion",
                                                     "whether it stands or slides",
                                                     "place in the image",
                                                     "place on the plate",
                                                     "place on the plate, across the motion",
                                                     "size of the tag",
                                                     "which tag it is",
                                                     "how fast tags move, row by row",
                                                     "velocity",
                                                     "command",
                                                     "position",
                                                     "place in the image",
                                                     "time"};
    return names.at(static_cast<std::size_t>(dependence));
}

}  // namespace fidservo::gap
