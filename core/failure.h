// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Why a function did not yield a value (core/result.h), for failures that may happen in a correct program.
#include <string_view>

namespace fidservo {

/// Why there is no value.
enum class Reason {
    no_tag,             ///< no fiducial in the image
    wrong_tag,          ///< a fiducial, but not the one expected at this place
    several_tags,       ///< the expected fiducial is there more than once
    occluded,           ///< the fiducial is partly hidden
    glare,              ///< the fiducial is partly saturated
    not_at_rest,        ///< the stage moves: nothing may be measured
    no_convergence,     ///< an iteration or a motion did not reach its goal in the time allowed
    out_of_reach,       ///< the stage cannot go there
    not_identifiable,   ///< the data do not determine the quantity
    feature_not_found,  ///< a printed feature is not where it should be
    no_image,           ///< the image that was to be measured again is not there
    device,             ///< a camera or a stage failed
    timeout,            ///< nothing arrived in the time allowed
    stopped,            ///< the user or the guardian ended the run
};

/// The word that stands for a reason in result files, e.g. "no_tag".
std::string_view name_of(Reason reason);

/// Whether nothing is worth trying after it: a device failed, or the run was stopped.
constexpr bool ends_the_run(Reason reason) {
    return reason == Reason::device || reason == Reason::stopped;
}

}  // namespace fidservo
