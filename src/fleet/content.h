// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fingerprints of the files from which a result is made.
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// SHA-256 over all files in some folders, by their names from `top` on and their bytes; the order in which
/// folders are given does not matter. Throws InputError if one cannot be read.
std::string content_of(const std::filesystem::path& top, const std::vector<std::filesystem::path>& folders);

/// SHA-256 over the bytes of files, in order. Throws InputError if one cannot be read.
std::string content_of_files(const std::vector<std::filesystem::path>& files);

}  // namespace fidservo::fleet
