// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/tiff_file.h"

#include "vision/images/image_file.h"

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdio>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fidservo::vision {
namespace {

int note_error(TIFF* /*tiff*/, void* to, const char* /*where*/, const char* format, va_list arguments) {
    auto& why = *static_cast<std::string*>(to);
    if (!why.empty()) return 1;
    char line[256];
    std::vsnprintf(line, sizeof line, format, arguments);
    why = line;
    std::ranges::replace(why, '\n', ' ');
    return 1;
}

int pass_over_warning(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) {
    return 0;
}

int leave_open(thandle_t) {
    return 0;
}

}  // namespace

Tiff::Tiff(const char* file, std::uint64_t page) : descriptor_(::open(file, O_RDONLY | O_CLOEXEC)) {
    struct stat state {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &state) != 0) {
        why_ = "cannot be opened";
        return;
    }
    size_ = static_cast<std::uint64_t>(state.st_size);
    if (page != 0) make_first(page);
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(most_file_bytes));
    TIFFOpenOptionsSetErrorHandlerExtR(options, &note_error, &why_);
    TIFFOpenOptionsSetWarningHandlerExtR(options, &pass_over_warning, nullptr);
    constexpr const char* read_without_mapping = "rm";  // a file may shrink while it is mapped
    tiff_ = TIFFClientOpenExt(
        file, read_without_mapping, this,
        [](thandle_t self, void* to, tmsize_t count) {
            return static_cast<Tiff*>(self)->read(static_cast<unsigned char*>(to), count);
        },
        &write_nothing,
        [](thandle_t self, toff_t place, int from) {
            return static_cast<toff_t>(static_cast<Tiff*>(self)->seek(place, from));
        },
        &leave_open, [](thandle_t self) { return static_cast<toff_t>(static_cast<Tiff*>(self)->size_); },
        nullptr, nullptr, options);
    TIFFOpenOptionsFree(options);
}

Tiff::~Tiff() {
    if (tiff_ != nullptr) TIFFClose(tiff_);
    if (descriptor_ >= 0) ::close(descriptor_);
}

/// The place of the first directory stands at 4 with four bytes; in a BigTIFF at 8 with eight.
void Tiff::make_first(std::uint64_t page) {
    constexpr unsigned char big = 43;
    if (::pread(descriptor_, header_.data(), header_.size(), 0) < 8) return;
    const bool least_first = header_[0] == 'I';
    const bool is_big = header_[least_first ? 2 : 3] == big;
    header_bytes_ = is_big ? 16 : 8;
    const std::size_t count = header_bytes_ / 2;
    for (std::size_t k = 0; k < count; ++k)
        header_[count + (least_first ? k : count - 1 - k)] = static_cast<unsigned char>(page >> (8 * k));
}

tmsize_t Tiff::read(unsigned char* to, tmsize_t count) {
    tmsize_t done = 0;
    while (done < count) {
        const auto got = ::pread(descriptor_, to + done, static_cast<std::size_t>(count - done),
                                 static_cast<off_t>(at_ + static_cast<std::uint64_t>(done)));
        if (got <= 0) break;
        done += got;
    }
    for (std::uint64_t place = at_; place < header_bytes_ && place < at_ + static_cast<std::uint64_t>(done);
         ++place)
        to[place - at_] = header_[place];
    at_ += static_cast<std::uint64_t>(done);
    return done;
}

std::uint64_t Tiff::seek(std::uint64_t place, int from) {
    at_ = place + (from == SEEK_CUR ? at_ : from == SEEK_END ? size_ : 0);
    return at_;
}

}  // namespace fidservo::vision
