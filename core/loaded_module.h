// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Libraries that are loaded at run time when first needed, because they bring many other libraries with
// them.
#include <string>

namespace fidservo {

/// A symbol of a library that was loaded at run time.
struct ModuleSymbol {
    const void* symbol = nullptr;
    std::string why;  ///< why there is no symbol, where there is none
};

/// Loads a library, which stays until the program ends.
/// @param library  its file's name; it is looked for in the program's run path, then in the system's folders
ModuleSymbol load_module_symbol(const char* library, const char* symbol);

}  // namespace fidservo
