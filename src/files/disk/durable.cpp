// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/disk/durable.h"

#include "core/input_error.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {
namespace {

[[noreturn]] void give_up(const std::filesystem::path& file) {
    throw RunFault(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

/// An open file; closed at the end of its life.
class OpenFile {
  public:
    OpenFile(const std::filesystem::path& file, int flags)
        : file_(file), descriptor_(::open(file.c_str(), flags | O_CLOEXEC, 0644)) {
        if (descriptor_ < 0) give_up(file_);
    }
    ~OpenFile() { ::close(descriptor_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    void write(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t written = ::write(descriptor_, text.data(), text.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) give_up(file_);
            text.remove_prefix(static_cast<std::size_t>(written));
        }
    }
    void sync() const {
        if (::fsync(descriptor_) != 0) give_up(file_);
    }

  private:
    std::filesystem::path file_;
    int descriptor_;
};

std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

void append_durably(const std::filesystem::path& file, std::string_view text) {
    {
        const OpenFile open(file, O_WRONLY | O_CREAT | O_APPEND);
        open.write(text);
        open.sync();
    }
    sync_to_disk(folder_of(file));
}

void sync_to_disk(const std::filesystem::path& file_or_folder) {
    OpenFile(file_or_folder, O_RDONLY).sync();
}

}  // namespace fidservo
