// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/media.h"

#include "core/failure.h"
#include "core/loaded_module.h"
#include "vision/images/regular_file.h"

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

Result<const MediaModule*> media() {
    static const ModuleSymbol loaded = load_module_symbol("libfidservo_media.so", media_symbol);
    if (loaded.symbol != nullptr) return static_cast<const MediaModule*>(loaded.symbol);
    return failure(Reason::device,
                   fmt::format("the module for this format cannot be loaded: {}", loaded.why));
}

/// What the module answers; the failure to load it, if there is none.
template <class Answer, class... Arguments>
Answer ask(Answer (*MediaModule::*question)(Arguments...), Arguments... arguments) {
    const auto module = media();
    if (!module) return tl::make_unexpected(module.error());
    return ((*module)->*question)(arguments...);
}

}  // namespace

Result<std::unique_ptr<Video>> open_video(const std::filesystem::path& file) {
    const auto refused = [&](const Failure& why) {
        return failure(Reason::device,
                       fmt::format("{}: cannot be read as a video: {}", file.string(), why.text));
    };
    if (const Status there = demand_regular_file(file); !there) return refused(there.error());
    auto video = ask(&MediaModule::open_video, file.c_str());
    if (!video) return refused(video.error());
    return video;
}

Result<cv::Mat> read_with_opencv(const std::filesystem::path& file) {
    return ask(&MediaModule::read_image, file.c_str());
}

bool is_image_for_opencv(const std::filesystem::path& file) {
    const auto module = media();
    return module && (*module)->is_image(file.c_str());
}

Result<std::vector<PageOfFile>> list_tiff_pages(const std::filesystem::path& file) {
    return ask(&MediaModule::list_tiff_pages, file.c_str());
}

Result<StoredImage> read_tiff_page(const std::filesystem::path& file, std::uint64_t page) {
    return ask(&MediaModule::read_tiff_page, file.c_str(), page);
}

}  // namespace fidservo::vision
