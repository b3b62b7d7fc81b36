// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/import_module.h"

#include "core/input_error.h"
#include "core/loaded_module.h"

#include <fmt/format.h>

namespace fidservo::imports {
const ImportModule& import_module(const std::filesystem::path& file) {
    static const ModuleSymbol loaded = load_module_symbol("libfidservo_import.so", import_symbol);
    if (loaded.symbol == nullptr)
        throw InputError(
            fmt::format("{}: the module for this format cannot be loaded: {}", file.string(), loaded.why));
    return *static_cast<const ImportModule*>(loaded.symbol);
}

}  // namespace fidservo::imports
