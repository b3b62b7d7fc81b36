// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fingerprints of the files that a run depends on.
#include <filesystem>
#include <string>
#include <string_view>

namespace fidservo {

/// SHA-256 in lower-case hexadecimal.
std::string sha256(std::string_view bytes);
/// The SHA-256 of a file's content, which is read in pieces. Throws InputError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace fidservo
