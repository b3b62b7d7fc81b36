// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cases with frames: effects of the image, which show in no other signal.
#include "src/selfcheck/draw/case_draw.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// Whether cases of a kind have frames. They are drawn separately from the other kinds.
bool has_frames(CaseKind kind);

/// Of four cases in a row two have an effect of the image, one has such an effect but withholds it from the
/// diagnosis, and one has no effect.
CaseKind kind_of_frames_case(std::uint64_t seed, std::size_t number);

/// A pure function of seed and number, as draw_case() is.
/// @param nominal  with a micro stage, controllers and a camera that looks straight down
Case draw_frames_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

/// The catalogue's names of the effects that are drawn.
std::vector<std::string_view> effects_in_frames();

}  // namespace fidservo::selfcheck
