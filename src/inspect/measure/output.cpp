// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/output.h"

#include <fmt/format.h>

namespace fidservo::inspect {

std::string visit_name(int tag_id, bool again) {
    return fmt::format("site-{:03}{}", tag_id, again ? "-again" : "");
}

std::string image_name(int tag_id, bool again, const std::string& view) {
    return fmt::format("images/{}-{}.png", visit_name(tag_id, again), view);
}

std::string recording_name(int tag_id, bool again) {
    return "recordings/" + visit_name(tag_id, again);
}

}  // namespace fidservo::inspect
