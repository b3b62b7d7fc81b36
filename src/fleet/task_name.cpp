// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/task_name.h"

#include "src/files/disk/sha256.h"

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

constexpr std::size_t most_bytes = 120, digest_digits = 12;

bool stays(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9') || letter == '-' || letter == '_' || letter == '.';
}

}  // namespace

std::string noted_path(const std::filesystem::path& given) {
    std::filesystem::path path = given.lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    if (path.is_absolute()) path = path.parent_path().filename() / path.filename();
    return path.empty() ? "." : path.string();
}

std::string file_stem(const std::string& noted) {
    std::string stem;
    for (std::size_t k = 0; k < noted.size(); ++k) {
        const char letter = noted[k];
        if (letter == '/')
            stem += '+';
        else if (stays(letter) && !(letter == '.' && k == 0))
            stem += letter;
        else
            stem += fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    if (stem.size() <= most_bytes) return stem;
    return sha256(noted).substr(0, digest_digits) + "%" + stem.substr(stem.size() - most_bytes);
}

}  // namespace fidservo::fleet
