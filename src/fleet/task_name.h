// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How results name the data from which they are made.
#include <filesystem>
#include <string>

namespace fidservo::fleet {

/// How a result notes the path of a campaign or an image folder: as it was given, without a / at its end and
/// with . and .. worked out as far as that needs no look at the disk. An absolute path is noted by its last
/// two names, so that results say nothing of the machine.
std::string noted_path(const std::filesystem::path& given);

/// A noted path as part of a file's name, unique for each path: / becomes +; letters, digits, - _ and . stay;
/// any other byte, and a . at the beginning, becomes %XX. If it is longer than 120 bytes, only its end is
/// kept, with digits of the SHA-256 of the whole in front.
std::string file_stem(const std::string& noted);

}  // namespace fidservo::fleet
