#include "gap/surrogate.h"

#include <array>

namespace fidservo::gap {

std::string_view name_of(Dependence dependence) {
    constexpr std::array<std::string_view, 12> names{"velocity",
                                                     "direction",
                                                     "position",
                                                     "position, periodic",
                                                     "acceleration",
                                                     "command",
                                                     "time",
                                                     "temperature",
                                                     "contraction",
                                                     "macro command",
                                                     "position, against the motion",
                                                     "place in the image"};
    return names.at(static_cast<std::size_t>(dependence));
}

std::string_view block_of(Signal signal, Dependence dependence) {
    switch (signal) {
        case Signal::encoder:
            if (dependence == Dependence::command || dependence == Dependence::time) return "macro.drive";
            if (dependence == Dependence::velocity || dependence == Dependence::direction ||
                dependence == Dependence::position_friction)
                return "macro.friction";
            return "macro.mechanics";
        case Signal::hall:
            if (dependence == Dependence::macro_command || dependence == Dependence::time ||
                dependence == Dependence::contraction)
                return "micro.hall";
            if (dependence == Dependence::acceleration) return "micro.mechanics";
            return dependence == Dependence::direction ? "micro.hysteresis" : "micro.heater";
        case Signal::tag:
            return dependence == Dependence::image_place ? "camera.geometry"
                   : dependence == Dependence::position  ? "plate"
                                                         : "camera.timing";
        case Signal::macro_command:
        case Signal::micro_command:
            break;
    }
    return "controller";
}

}  // namespace fidservo::gap
