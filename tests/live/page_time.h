// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The time that a page takes to open in headless Chromium.
#include <filesystem>
#include <optional>

namespace fidservo::testing {

/// From the beginning of the navigation until two frames after the page and all that it does while it loads,
/// s. Empty if Chromium is not installed. Throws std::runtime_error if the page does not open.
/// @param profile  a folder that does not exist yet
std::optional<double> page_drawn_s(const std::filesystem::path& page, const std::filesystem::path& profile);

}  // namespace fidservo::testing
