#include "gap/surrogate.h"

#include <array>

namespace fidservo::gap {

std::string_view name_of(Dependence dependence) {
    constexpr std::array<std::string_view, 21> names{"velocity",
                                                     "direction",
                                                     "position",
                                                     "position, periodic",
                                                     "position, periodic in the reading",
                                                     "acceleration",
                                                     "command",
                                                     "changes of the command",
                                                     "nothing: a constant force",
                                                     "time",
                                                     "temperature",
                                                     "temperature before",
                                                     "turns between the wire's end states",
                                                     "contraction",
                                                     "macro command",
                                                     "position, against the motion",
                                                     "place in the image",
                                                     "place on the plate",
                                                     "size of the tag",
                                                     "which tag it is",
                                                     "how fast tags move, row by row"};
    return names.at(static_cast<std::size_t>(dependence));
}

}  // namespace fidservo::gap
