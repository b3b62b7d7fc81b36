// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files that survive a crash and a power cut: on the disk before the caller goes on.
#include <filesystem>
#include <string_view>

namespace fidservo {

/// Adds text at the end of a file that exists or is made. Throws RunFault if the disk does not take all of
/// it.
void append_durably(const std::filesystem::path& file, std::string_view text);

/// Waits until what was written to a file or a folder's list of names is on the disk. Throws RunFault.
void sync_to_disk(const std::filesystem::path& file_or_folder);

}  // namespace fidservo
