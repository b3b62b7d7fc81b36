// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Access to a TIFF's bytes for libtiff.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <tiffio.h>

namespace fidservo::vision {

/// An open TIFF. The first of libtiff's error messages is kept.
class Tiff {
  public:
    /// @param page  the file offset of a directory that is presented to libtiff as the file's first one:
    /// otherwise libtiff would walk through all directories before it and report what is wrong there. 0: the
    /// file's own first one
    explicit Tiff(const char* file, std::uint64_t page = 0);
    ~Tiff();
    Tiff(const Tiff&) = delete;
    Tiff& operator=(const Tiff&) = delete;

    TIFF* get() const { return tiff_; }
    bool is_open() const { return tiff_ != nullptr; }
    bool has_failed() const { return !why_.empty(); }
    std::string why() const { return why_.empty() ? "cut short" : why_; }
    std::uint64_t file_bytes() const { return size_; }

    template <class Value>
    Value field(std::uint32_t tag, Value otherwise) const {
        Value value = otherwise;
        return TIFFGetFieldDefaulted(tiff_, tag, &value) == 1 ? value : otherwise;
    }

  private:
    void make_first(std::uint64_t page);
    tmsize_t read(unsigned char* to, tmsize_t count);
    std::uint64_t seek(std::uint64_t place, int from);

    int descriptor_;
    std::uint64_t size_ = 0, at_ = 0;
    std::array<unsigned char, 16> header_{};  ///< presented to libtiff in place of the file's own header
    std::size_t header_bytes_ = 0;
    std::string why_;
    TIFF* tiff_ = nullptr;
};

}  // namespace fidservo::vision
