// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/failure.h"
#include "core/result.h"

#include <filesystem>
#include <system_error>

namespace fidservo::vision {

/// Fails with Reason::device, without the file's name, for what is not there and for what is no regular file:
/// a pipe blocks whoever opens it until somebody writes, and a device may have no end.
inline Status demand_regular_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto kind = std::filesystem::status(file, error).type();
    if (kind == std::filesystem::file_type::regular) return {};
    if (kind == std::filesystem::file_type::not_found)
        return failure(Reason::device, "there is no such file");
    if (error) return failure(Reason::device, error.message());
    return failure(Reason::device, "it is a pipe, a device or a folder: a regular file must be given");
}

}  // namespace fidservo::vision
