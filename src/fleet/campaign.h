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
    /// The unit, the beginning of the first recording, and those labels on which all recordings that have
    /// them agree.
    RecordingOrigin origin;
    std::string fault;  ///< why it cannot be diagnosed: no recording, no statements in it, or two units
};

/// Reads a campaign: recording.yaml is parsed, all other files are only hashed.
Campaign campaign_of(const std::filesystem::path& path);

}  // namespace fidservo::fleet
