// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files that are completely on the disk when a call returns.

#include "core/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace fidservo {

/// Collects what is appended and writes it in large pieces. A write that fails (a full disk) is remembered
/// and returned by every later call: nothing is lost silently.
class DurableFile {
  public:
    /// Creates the file; fails with Reason::device if it exists or cannot be made.
    static Result<DurableFile> create(const std::filesystem::path& file);
    DurableFile(DurableFile&& other) noexcept;
    DurableFile& operator=(DurableFile&&) = delete;
    ~DurableFile();

    Status append(std::string_view text);
    /// Hands the collected text to the system: it survives the program's being killed, but not a power
    /// failure.
    Status flush() { return write_out(); }
    /// Writes what is still collected, and waits until the disk has it all.
    Status close();

  private:
    DurableFile(std::filesystem::path file, int descriptor);
    Status write_out();
    Status fail_with(const char* what);

    std::filesystem::path file_;
    int descriptor_;
    std::string pending_;
    std::string fault_;
};

/// Writes a whole small file; the same guarantees.
Status write_durably(const std::filesystem::path& file, std::string_view text);

/// The same; throws RunFault if the disk does not take it, or the file exists.
void write_or_throw(const std::filesystem::path& file, std::string_view text);

/// Replaces a file in one step: a reader sees the old text or the new, never a part. Throws RunFault if the
/// disk does not take it.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// Waits until the names of a folder's files are on the disk.
Status sync_folder(const std::filesystem::path& folder);

}  // namespace fidservo
