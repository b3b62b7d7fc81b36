#include "gap/surrogate.h"

#include <array>

namespace fidservo::gap {

std::string_view name_of(Dependence dependence) {
    constexpr std::array<std::string_view, 14> names{"velocity",
                                                     "direction",
                                                     "position",
                                                     "position, periodic",
                                                     "acceleration",
                                                     "command",
                                                     "changes of the command",
                                                     "nothing: a constant force",
                                                     "time",
                                                     "temperature",
                                                     "contraction",
                                                     "macro command",
                                                     "position, against the motion",
                                                     "place in the image"};
    return names.at(static_cast<std::size_t>(dependence));
}

}  // namespace fidservo::gap
