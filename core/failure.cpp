// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/failure.h"

#include <cstdlib>

namespace fidservo {

std::string_view name_of(Reason reason) {
    switch (reason) {
        case Reason::no_tag:
            return "no_tag";
        case Reason::wrong_tag:
            return "wrong_tag";
        case Reason::several_tags:
            return "several_tags";
        case Reason::occluded:
            return "occluded";
        case Reason::glare:
            return "glare";
        case Reason::not_at_rest:
            return "not_at_rest";
        case Reason::no_convergence:
            return "no_convergence";
        case Reason::out_of_reach:
            return "out_of_reach";
        case Reason::not_identifiable:
            return "not_identifiable";
        case Reason::feature_not_found:
            return "feature_not_found";
        case Reason::no_image:
            return "no_image";
        case Reason::device:
            return "device";
        case Reason::timeout:
            return "timeout";
        case Reason::stopped:
            return "stopped";
    }
    std::abort();
}

}  // namespace fidservo
