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

/// The folders in which the program's own libraries are looked for: its run path, then the system's. Asked
/// for by name, a library would be sought on the run path of who calls dlopen, which under the address
/// sanitizer is not the program.
std::vector<std::string> library_folders() {
    void* program = dlopen(nullptr, RTLD_LAZY);
    Dl_serinfo size{};
    if (program == nullptr || dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0) return {};
    std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
    auto* found = reinterpret_cast<Dl_serinfo*>(memory.data());
    if (dlinfo(program, RTLD_DI_SERINFOSIZE, found) != 0 || dlinfo(program, RTLD_DI_SERINFO, found) != 0)
        return {};
    std::vector<std::string> folders;
    const Dl_serpath* paths = found->dls_serpath;  // as many as dls_cnt, though declared as one
    for (unsigned int k = 0; k < found->dls_cnt; ++k) folders.emplace_back(paths[k].dls_name);
    return folders;
}

/// It stays until the program ends.
Loaded load() {
    constexpr const char* name = "libfidservo_media.so";
    for (const std::string& folder : library_folders()) {
        const std::string file = folder + "/" + name;
        if (access(file.c_str(), R_OK) != 0) continue;
        void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) return {nullptr, dlerror()};
        const void* symbol = dlsym(library, media_symbol);
        if (symbol == nullptr) return {nullptr, dlerror()};
        return {static_cast<const MediaModule*>(symbol), {}};
    }
    return {nullptr, fmt::format("there is no {} beside the program's libraries", name)};
}

Result<const MediaModule*> media() {
    static const Loaded loaded = load();
    if (loaded.module != nullptr) return loaded.module;
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
    auto video = ask(&MediaModule::open_video, file.c_str());
    if (!video)
        return failure(Reason::device,
                       fmt::format("{}: cannot be read as a video: {}", file.string(), video.error().text));
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
