// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A campaign as a fleet sees it: recordings of one rig, made at about one time.
#include "src/files/recording/description.h"

#include <filesystem>
#include <string>

namespace fidservo::fleet {

struct Campaign {
    std::string noted;    ///< its path (noted_path)
    std::string content;  ///< SHA-256 of its recordings' files
    /// Of its recordings: the unit, when the first of them began, and of the labels those on which all that
    /// have them agree.
    RecordingOrigin origin;
    std::string fault;  ///< why it cannot be diagnosed: no recording in it, one that says nothing, two units
};

/// Looks at a campaign; of its recordings only recording.yaml is read as more than bytes.
Campaign campaign_of(const std::filesystem::path& path);

}  // namespace fidservo::fleet
