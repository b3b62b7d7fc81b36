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
