// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// recording.yaml: what a recording states about itself (docs/formats.md).
#include "core/recording.h"

#include <filesystem>
#include <map>
#include <string>

namespace fidservo {

class YamlValue;

/// How a recording was made: with which devices, of which unit, when; empty: not stated. A diagnosis does not
/// use it.
struct RecordingOrigin {
    std::string stage{};        ///< sim | comedi:/dev/comedi0
    std::string camera{};       ///< sim | v4l2:/dev/video0
    std::string program{};      ///< fidservo 0.1.0 (commit)
    std::string unit{};         ///< the rig, among several of the same kind
    std::string recorded_at{};  ///< when it began, in UTC: 2026-11-02T08:15:00Z
    /// SHA-256 of what the recording was asked to be: of the rig's files, the seed and all commands.
    std::string request_sha256{};
    std::map<std::string, std::string> labels{};  ///< other labels that users give to distinguish recordings
};

/// "fidservo 0.1.0 (COMMIT)".
std::string this_program();

/// The text of recording.yaml; only those fields of the recording are used.
std::string description_yaml(const Recording& recording, const RecordingOrigin& origin);

/// The origin as a YAML map states it. Throws InputError.
RecordingOrigin read_origin(const YamlValue& map);

/// The origin as a recording.yaml states it.
RecordingOrigin read_origin(const std::filesystem::path& file);

/// Reads recording.yaml into those fields of a recording that it states. Throws InputError.
void read_description(const std::filesystem::path& file, Recording& recording);

/// Reads the keys that recording.yaml shares with the map of an import: all but format, tick_s and finished.
/// The caller decides which keys are allowed. Throws InputError.
void read_statements(const YamlValue& map, Recording& recording);

}  // namespace fidservo
