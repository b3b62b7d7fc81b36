// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "plant/effects/effect.h"
#include "src/files/recording/description.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace fidservo {

struct Rig;

/// Runs an experiment like simulate() and writes its recording with the camera's frames, each as soon as it
/// is exposed; detections are what the detector finds in them. Throws InputError if the folder exists or the
/// rig has nothing to take frames with or of, RunFault if the disk fails.
void write_filmed_recording(const std::filesystem::path& folder, const Rig& rig,
                            std::span<const plant::EffectSetting> effects, const Experiment& experiment,
                            const std::string& name, std::uint64_t seed, const RecordingOrigin& origin = {});

}  // namespace fidservo
