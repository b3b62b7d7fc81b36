// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/disk/output_paths.h"

#include "core/input_error.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {

void demand_new_file(const char* option, const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (file.empty()) return;
    if (fs::symlink_status(file, error).type() != fs::file_type::not_found)
        throw InputError(
            fmt::format("{}: {}: exists already; give the name of a new file", option, file.string()));
    const auto above = [](const fs::path& path) {
        return path.has_parent_path() ? path.parent_path() : fs::path(".");
    };
    fs::path folder = above(file);
    while (!fs::exists(folder, error)) folder = above(folder);
    if (!fs::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
        throw InputError(fmt::format("{}: {}: cannot be made in {}: {}", option, file.string(),
                                     folder.string(),
                                     fs::is_directory(folder, error) ? std::strerror(errno) : "no folder"));
}

void make_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    if (std::filesystem::symlink_status(folder, error).type() != std::filesystem::file_type::not_found)
        throw InputError(
            fmt::format("--out: {}: exists already; give the name of a new folder", folder.string()));
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(fmt::format("--out: {}: cannot be made: {}", folder.string(), error.message()));
}

void demand_new_folder(const std::filesystem::path& folder) {
    make_output_folder(folder);
    std::error_code ignored;
    std::filesystem::remove(folder, ignored);
}

void set_aside(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return;
    // A folder's name may hold a dot and yet no extension.
    const bool has_extension = !std::filesystem::is_directory(path);
    const std::string stem = (has_extension ? path.stem() : path.filename()).string();
    const std::string extension = has_extension ? path.extension().string() : "";
    for (int k = 1;; ++k) {
        const auto other = path.parent_path() / fmt::format("{}.interrupted-{}{}", stem, k, extension);
        if (std::filesystem::exists(other)) continue;
        std::error_code problem;
        std::filesystem::rename(path, other, problem);
        if (problem)
            throw RunFault(fmt::format("{}: cannot be renamed: {}", path.string(), problem.message()));
        return;
    }
}

void demand_appendable(const char* option, const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (fs::is_directory(file, error))
        throw InputError(fmt::format("{}: {}: is a folder; allowed: a file", option, file.string()));
    if (!fs::is_directory(folder, error))
        throw InputError(fmt::format("{}: {}: its folder does not exist", option, file.string()));
    const fs::path& written = fs::exists(file, error) ? file : folder;
    if (::access(written.c_str(), W_OK) != 0)
        throw InputError(
            fmt::format("{}: {}: cannot be written: {}", option, file.string(), std::strerror(errno)));
}

}  // namespace fidservo
