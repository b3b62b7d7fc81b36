// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A campaign of a fleet: recordings of one rig from about one time.
#include "src/files/recording/description.h"

#include <filesystem>
#include <string>

namespace fidservo::fleet {

struct Campaign {
    std::string noted;    ///< its path as results note it (noted_path)
    std::string content;  ///< SHA-256 of its recordings' files
    /// The unit, the start of the first recording, and the labels; a label on which recordings differ is left
    /// out.
    RecordingOrigin origin;
    std::string fault;  ///< why it cannot be diagnosed: no recording, no statements in it, or two units
};

/// Reads a campaign: recording.yaml is parsed, all other files are only hashed.
Campaign campaign_of(const std::filesystem::path& path);

}  // namespace fidservo::fleet
