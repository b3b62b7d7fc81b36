// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence.h"

namespace fidservo::gap {

std::vector<Signal> reach_of(const plant::Effect& effect) {
    switch (effect.part) {
        case plant::Part::carriage:
        case plant::Part::encoder:
            return {Signal::encoder, Signal::tag};
        case plant::Part::wire:
        case plant::Part::platform:
            return {Signal::hall};
        case plant::Part::hall:
            return {Signal::hall, Signal::tag};
        case plant::Part::view:
        case plant::Part::shutter:
            return {Signal::tag};
        case plant::Part::exposure:
            return {Signal::tag, Signal::image};
        case plant::Part::image:
            return {Signal::image};
    }
    return {};
}

}  // namespace fidservo::gap
