#include "src/import/import_module.h"

#include "core/input_error.h"

#include <string>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

namespace fidservo::imports {
namespace {

struct Loaded {
    const ImportModule* module = nullptr;
    std::string why;  ///< there is none
};

/// The program's run path, then the system's folders.
std::vector<std::string> folders_of_libraries() {
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
Loaded load_import_module() {
    constexpr const char* name = "libfidservo_import.so";
    for (const std::string& folder : folders_of_libraries()) {
        const std::string file = folder + "/" + name;
        if (access(file.c_str(), R_OK) != 0) continue;
        void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) return {nullptr, dlerror()};
        const void* symbol = dlsym(library, import_symbol);
        if (symbol == nullptr) return {nullptr, dlerror()};
        return {static_cast<const ImportModule*>(symbol), {}};
    }
    return {nullptr, fmt::format("there is no {} beside the program's libraries", name)};
}

}  // namespace

const ImportModule& import_module(const std::filesystem::path& file) {
    static const Loaded loaded = load_import_module();
    if (loaded.module == nullptr)
        throw InputError(
            fmt::format("{}: the module for this format cannot be loaded: {}", file.string(), loaded.why));
    return *loaded.module;
}

}  // namespace fidservo::imports
