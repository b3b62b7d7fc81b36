#include "vision/images/media.h"

#include "core/failure.h"

#include <string>

#include <dlfcn.h>
#include <fmt/format.h>

namespace fidservo::vision {
namespace {

struct Loaded {
    const MediaModule* module = nullptr;
    std::string why;  ///< there is none
};

/// Found by the program's own search path: beside it where it was built, in the installation's folder of
/// libraries otherwise. It stays until the program ends.
Loaded load() {
    void* library = dlopen("libfidservo_media.so", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return {nullptr, dlerror()};
    const void* symbol = dlsym(library, media_symbol);
    if (symbol == nullptr) return {nullptr, dlerror()};
    return {static_cast<const MediaModule*>(symbol), {}};
}

Result<const MediaModule*> media(const std::filesystem::path& wanted_for) {
    static const Loaded loaded = load();
    if (loaded.module != nullptr) return loaded.module;
    return failure(Reason::device, fmt::format("{}: the module for this format cannot be loaded: {}",
                                               wanted_for.string(), loaded.why));
}

}  // namespace

Result<std::unique_ptr<Video>> open_video(const std::filesystem::path& file) {
    const auto module = media(file);
    if (!module) return tl::make_unexpected(module.error());
    std::unique_ptr<Video> video((*module)->open_video(file.c_str()));
    if (!video) return failure(Reason::device, fmt::format("{}: cannot be read as a video", file.string()));
    return video;
}

Result<cv::Mat> read_grey_with_opencv(const std::filesystem::path& file) {
    const auto module = media(file);
    if (!module) return tl::make_unexpected(module.error());
    cv::Mat grey = (*module)->read_grey(file.c_str());
    if (grey.empty())
        return failure(Reason::device, fmt::format("{}: cannot be read as an image", file.string()));
    return grey;
}

}  // namespace fidservo::vision
