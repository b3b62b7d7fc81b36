// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// recording.yaml: what a recording states about itself (docs/formats.md).
#include "core/recording.h"

#include <filesystem>
#include <map>
#include <string>

namespace fidservo {

class YamlValue;

/// What a recording was made with, of what and when; empty: not stated. A diagnosis concludes nothing from
/// it.
struct RecordingOrigin {
    std::string stage{};                          ///< sim | comedi:/dev/comedi0
    std::string camera{};                         ///< sim | v4l2:/dev/video0
    std::string program{};                        ///< fidservo 0.1.0 (commit)
    std::string unit{};                           ///< which of several rigs of a kind
    std::string recorded_at{};                    ///< when it began, in UTC: 2026-11-02T08:15:00Z
    std::map<std::string, std::string> labels{};  ///< whatever else people tell recordings apart by
};

/// "fidservo 0.1.0 (COMMIT)".
std::string this_program();

/// The text of recording.yaml; of the recording only what is stated there is looked at.
std::string description_yaml(const Recording& recording, const RecordingOrigin& origin);

/// What a map says of it. Throws InputError.
RecordingOrigin read_origin(const YamlValue& map);

/// The same of a recording.yaml.
RecordingOrigin read_origin(const std::filesystem::path& file);

/// Reads recording.yaml into those fields of a recording that it states. Throws InputError.
void read_description(const std::filesystem::path& file, Recording& recording);

/// The part of it that a map of an import shares: all but format, tick_s and finished. Which keys are allowed
/// is for the caller to say. Throws InputError.
void read_statements(const YamlValue& map, Recording& recording);

}  // namespace fidservo
