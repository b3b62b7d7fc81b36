// SPDX-License-Identifier: GPL-3.0-or-later
// Which pictures a TIFF has: its directories, and what programs say of pictures that have none.
#include "core/failure.h"
#include "vision/images/module/parts.h"
#include "vision/images/module/tiff_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

/// Is it a smaller copy of another page, or a mask for one?
bool is_companion(const Tiff& tiff) {
    std::uint32_t kind = 0;
    std::uint16_t old_kind = 0;
    if (TIFFGetField(tiff.get(), TIFFTAG_SUBFILETYPE, &kind) == 1)
        return (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
    return TIFFGetField(tiff.get(), TIFFTAG_OSUBFILETYPE, &old_kind) == 1 &&
           old_kind == OFILETYPE_REDUCEDIMAGE;
}

/// Has the page directories below it, where cameras' raw files (TIFF/EP, DNG) keep the picture?
bool has_directories_of_its_own(const Tiff& tiff) {
    std::uint16_t count = 0;
    const std::uint64_t* places = nullptr;
    return TIFFGetField(tiff.get(), TIFFTAG_SUBIFD, &count, &places) == 1 && count > 0;
}

/// How many pictures a directory stands for, and by what that is stated.
struct StatedPictures {
    std::uint64_t count = 0;  ///< 0: nothing states it
    std::string_view by{};
};

/// The whole number at the beginning of a text, 0 without one; takes it off.
std::uint64_t take_whole_number(std::string_view& text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return error == std::errc() ? number : 0;
}

/// ImageJ's lines "ImageJ=1.53t", "images=4".
StatedPictures stated_by_imagej(std::string_view description) {
    constexpr std::string_view key = "\nimages=";
    const std::size_t at = description.find(key);
    if (!description.starts_with("ImageJ=") || at == std::string_view::npos) return {};
    description.remove_prefix(at + key.size());
    return {take_whole_number(description), "ImageJ's description"};
}

/// tifffile's {"truncated": true, "shape": [4, 320, 480]}, which is of all samples that it wrote together.
StatedPictures stated_by_tifffile(const Tiff& tiff, std::string_view description) {
    constexpr std::string_view key = "\"shape\": [";
    constexpr std::uint64_t most = std::uint64_t{1} << 48U;
    const std::size_t at = description.find(key);
    if (!description.starts_with("{\"") || at == std::string_view::npos) return {};
    description.remove_prefix(at + key.size());
    std::uint64_t samples = 1;
    while (!description.empty() && description.front() != ']') {
        const std::uint64_t side = take_whole_number(description);
        if (side == 0 || side > most / samples) return {};
        samples *= side;
        while (description.starts_with(",") || description.starts_with(" ")) description.remove_prefix(1);
    }
    const std::uint64_t of_a_page = std::uint64_t{tiff.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0)} *
                                    tiff.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0) *
                                    tiff.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    if (of_a_page == 0 || samples % of_a_page != 0) return {};
    return {samples / of_a_page, "tifffile's description"};
}

StatedPictures stated_pictures(const Tiff& tiff) {
    constexpr std::uint32_t metamorph_planes = 33629;
    std::uint32_t planes = 0;
    const void* ignored = nullptr;
    if (TIFFGetField(tiff.get(), metamorph_planes, &planes, &ignored) == 1 && planes > 1)
        return {planes, "MetaMorph's tag UIC2"};
    if (const auto depth = tiff.field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1); depth > 1)
        return {depth, "the tag ImageDepth"};
    const char* text = nullptr;
    if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &text) != 1 || text == nullptr) return {};
    const StatedPictures by_imagej = stated_by_imagej(text);
    return by_imagej.count > 0 ? by_imagej : stated_by_tifffile(tiff, text);
}

/// Counts the pictures of a file. What a directory states is of it and of those that follow and state
/// nothing.
class PictureCount {
  public:
    void add(const Tiff& tiff) {
        ++directories_;
        const StatedPictures stated = stated_pictures(tiff);
        if (stated.count == 0) {
            ++of_these_;
            return;
        }
        before_ = all();
        of_these_ = 1;
        stated_ = stated.count;
        if (stated.count > 1) by_ = stated.by;
    }

    /// That pictures have no directory; empty if all have one.
    std::string note() const {
        if (all() <= directories_) return {};
        return fmt::format(
            "{} of {} pages {} read: the others, which {} counts, have no directory of their own",
            directories_, all(), directories_ == 1 ? "is" : "are", by_);
    }

  private:
    std::uint64_t all() const { return before_ + std::max(stated_, of_these_); }

    std::uint64_t directories_ = 0, before_ = 0;
    std::uint64_t stated_ = 0, of_these_ = 0;  ///< since the last directory that states a number
    std::string_view by_;
};

}  // namespace

Result<std::vector<PageOfFile>> tiff_pages(const char* file) {
    const Tiff tiff(file);
    if (!tiff.is_open()) return std::vector<PageOfFile>{{.damage = "damaged TIFF: " + tiff.why()}};
    std::vector<PageOfFile> pages, companions;
    PictureCount pictures;
    bool holds_its_picture_elsewhere = false;
    while (true) {
        holds_its_picture_elsewhere = holds_its_picture_elsewhere || has_directories_of_its_own(tiff);
        const bool companion = is_companion(tiff);
        if (!companion) pictures.add(tiff);
        (companion ? companions : pages)
            .push_back({.page = TIFFCurrentDirOffset(tiff.get()),
                        .is_deep = tiff.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1) > 8});
        if (pages.size() + companions.size() > most_pages)
            return failure(Reason::device, fmt::format("more pages than the {} that are read", most_pages));
        if (TIFFLastDirectory(tiff.get()) != 0) break;
        if (TIFFReadDirectory(tiff.get()) == 1) continue;
        pages.push_back(
            {.damage = fmt::format("damaged TIFF: its list of pages is broken off here: {}", tiff.why())});
        break;
    }
    if (!pages.empty()) {
        pages.front().note = pictures.note();
        return pages;
    }
    if (holds_its_picture_elsewhere)
        return std::vector<PageOfFile>{{.damage = "only a reduced copy of its picture is a page; the picture "
                                                  "itself (a camera's raw data, say) "
                                                  "is not read"}};
    return companions;
}

}  // namespace fidservo::vision
