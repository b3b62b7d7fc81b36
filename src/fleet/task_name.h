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

/// A noted path as part of a file's name, another one for any other path: / becomes +; letters, digits, - _
/// and . stay; any other byte, and a . at the beginning, becomes %XX. Of more than 120 bytes the last are
/// kept, and the whole is told apart by digits of its SHA-256 in front.
std::string file_stem(const std::string& noted);

}  // namespace fidservo::fleet
