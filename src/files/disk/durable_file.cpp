// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/disk/durable_file.h"

#include "core/failure.h"
#include "core/input_error.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {

namespace {

constexpr std::size_t piece_bytes = 1u << 18;

std::string describe_errno(const std::filesystem::path& file, const char* what) {
    return fmt::format("{}: {}: {}", file.string(), what, std::strerror(errno));
}

}  // namespace

Result<DurableFile> DurableFile::create(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (descriptor < 0) return failure(Reason::device, describe_errno(file, "cannot be made"));
    return DurableFile(file, descriptor);
}

DurableFile::DurableFile(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {
    pending_.reserve(piece_bytes + 4096);
}

DurableFile::DurableFile(DurableFile&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      pending_(std::move(other.pending_)),
      fault_(std::move(other.fault_)) {}

DurableFile::~DurableFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Status DurableFile::append(std::string_view text) {
    pending_ += text;
    return pending_.size() < piece_bytes ? Status{} : write_out();
}

Status DurableFile::close() {
    if (auto written = write_out(); !written) return written;
    if (::fsync(descriptor_) != 0) return fail_with("cannot be written to the disk");
    if (::close(std::exchange(descriptor_, -1)) != 0) return fail_with("cannot be closed");
    return {};
}

Status DurableFile::write_out() {
    if (!fault_.empty()) return failure(Reason::device, fault_);
    std::string_view rest = pending_;
    while (!rest.empty()) {
        const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno != EINTR) return fail_with("cannot be written");
        if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
    }
    pending_.clear();
    return {};
}

Status DurableFile::fail_with(const char* what) {
    fault_ = describe_errno(file_, what);
    pending_.clear();
    return failure(Reason::device, fault_);
}

Status write_durably(const std::filesystem::path& file, std::string_view text) {
    auto created = DurableFile::create(file);
    if (!created) return tl::make_unexpected(created.error());
    if (auto appended = created->append(text); !appended) return appended;
    return created->close();
}

void write_or_throw(const std::filesystem::path& file, std::string_view text) {
    if (const Status written = write_durably(file, text); !written) throw RunFault(written.error().text);
}

void replace_file(const std::filesystem::path& file, std::string_view text) {
    std::filesystem::path draft = file;
    draft += ".part";
    std::error_code none;
    std::filesystem::remove(draft, none);
    write_or_throw(draft, text);
    std::error_code problem;
    std::filesystem::rename(draft, file, problem);
    if (problem) throw RunFault(fmt::format("{}: cannot be written: {}", file.string(), problem.message()));
    if (const Status synced = sync_folder(file.has_parent_path() ? file.parent_path() : "."); !synced)
        throw RunFault(synced.error().text);
}

Status sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return failure(Reason::device, describe_errno(folder, "cannot be opened"));
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL;
    std::string fault = synced ? "" : describe_errno(folder, "cannot be written to the disk");
    ::close(descriptor);
    return synced ? Status{} : Status(failure(Reason::device, std::move(fault)));
}

}  // namespace fidservo
