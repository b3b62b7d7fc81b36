// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What to do after a diagnosis, with the commands to run.
#include "gap/diagnosis.h"
#include "src/diagnose/designed_experiment.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::diagnose {

/// The options of a diagnosis, which are repeated in proposed commands.
struct Request {
    std::filesystem::path rig_file;
    std::vector<std::filesystem::path> recordings;
    std::vector<std::string> only, without;  ///< effects
    std::filesystem::path written_rig;       ///< empty if none was asked for
    std::shared_ptr<const DesignedNext> designed = nullptr;
};

/// An experiment that decides, what to do about a remainder, how to close the gap, and what could not be
/// judged.
std::string next_steps_html(const gap::Diagnosis& diagnosis, const Rig& rig, const Request& request);

}  // namespace fidservo::diagnose
