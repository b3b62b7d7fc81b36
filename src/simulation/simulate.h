// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/recording.h"
#include "plant/effects/effect.h"
#include "src/simulation/experiments.h"
#include "src/simulation/film_camera.h"

#include <cstdint>
#include <span>
#include <string>

namespace fidservo {

struct Rig;

/// Runs an experiment on the simulated rig under the published controllers, and records it as the real one
/// would be recorded: what the sensors read, what was commanded, the fiducials that the camera saw.
/// @param effects  effects of the rig that its file does not state
/// @param name     of the recording; together with the seed it determines all noise
/// @param keep_frame  if given, frames are rendered and the fiducials are found in them; otherwise detections
///                    are made without images (practice_detections.h). Needs a rig with camera and fiducials
Recording simulate(const Rig& rig, std::span<const plant::EffectSetting> effects,
                   const Experiment& experiment, const std::string& name, std::uint64_t seed,
                   const FilmCamera::Keep& keep_frame = {});

}  // namespace fidservo
