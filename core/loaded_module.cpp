// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/loaded_module.h"

#include <cstddef>
#include <vector>

#include <dlfcn.h>
#include <unistd.h>

namespace fidservo {

namespace {

/// What this code is linked into: a module of Python's, or the program.
void* own_object() {
    Dl_info own{};
    void* module = dladdr(reinterpret_cast<const void*>(&own_object), &own) != 0
                       ? dlopen(own.dli_fname, RTLD_LAZY | RTLD_NOLOAD)
                       : nullptr;
    return module != nullptr ? module : dlopen(nullptr, RTLD_LAZY);
}

/// The folders in which its own libraries are looked for: its run path, then the system's. Asked for by name,
/// a library would be sought on the run path of who calls dlopen, which under the address sanitizer is not
/// the program.
std::vector<std::string> library_folders() {
    void* object = own_object();
    Dl_serinfo size{};
    if (object == nullptr || dlinfo(object, RTLD_DI_SERINFOSIZE, &size) != 0) return {};
    std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
    auto* found = reinterpret_cast<Dl_serinfo*>(memory.data());
    if (dlinfo(object, RTLD_DI_SERINFOSIZE, found) != 0 || dlinfo(object, RTLD_DI_SERINFO, found) != 0)
        return {};
    std::vector<std::string> folders;
    const Dl_serpath* paths = found->dls_serpath;  // as many as dls_cnt, though declared as one
    for (unsigned int k = 0; k < found->dls_cnt; ++k) folders.emplace_back(paths[k].dls_name);
    return folders;
}

}  // namespace

ModuleSymbol load_module_symbol(const char* library, const char* symbol) {
    for (const std::string& folder : library_folders()) {
        const std::string file = folder + "/" + library;
        if (access(file.c_str(), R_OK) != 0) continue;
        void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (module == nullptr) return {nullptr, dlerror()};
        const void* found = dlsym(module, symbol);
        if (found == nullptr) return {nullptr, dlerror()};
        return {found, {}};
    }
    return {nullptr, std::string("there is no ") + library + " beside the program's libraries"};
}

}  // namespace fidservo
