// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether two sets of recordings state that they are of one rig: what differs between two rigs has not
// changed in either.
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::compare {

/// What the sets' files recording.yaml state of the rig that is not the same in all of them: a sentence on
/// the unit and the name of the rig, and one on the labels. What only one of the sets states is not held
/// against the other.
/// @param before, after  the sets A and B, as find_recordings() takes them
/// Throws InputError where a set has no recordings, or a file is not as it should be.
std::vector<std::string> notes_on_rigs(const std::filesystem::path& before,
                                       const std::filesystem::path& after);

}  // namespace fidservo::compare
