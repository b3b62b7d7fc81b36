// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/content.h"

#include "core/input_error.h"
#include "src/files/disk/sha256.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::fleet {

namespace fs = std::filesystem;

std::string content_of(const fs::path& top, const std::vector<fs::path>& folders) {
    std::vector<fs::path> files;
    try {
        for (const fs::path& folder : folders)
            for (const auto& entry : fs::recursive_directory_iterator(folder))
                if (entry.is_regular_file()) files.push_back(entry.path());
    } catch (const fs::filesystem_error& error) {
        throw InputError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    }
    std::ranges::sort(files);
    std::string all;
    for (const fs::path& file : files)
        all += fmt::format("{} {}\n", sha256_of_file(file), file.lexically_relative(top).string());
    return sha256(all);
}

std::string content_of_files(const std::vector<fs::path>& files) {
    if (files.size() == 1) return sha256_of_file(files.front());
    std::string all;
    for (const fs::path& file : files) all += sha256_of_file(file) + "\n";
    return sha256(all);
}

}  // namespace fidservo::fleet
