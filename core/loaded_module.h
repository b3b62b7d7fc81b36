// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Libraries that are loaded when they are asked for: what brings many others is not in the program itself.
#include <string>

namespace fidservo {

/// A symbol of a library that is beside the program's own ones.
struct ModuleSymbol {
    const void* symbol = nullptr;
    std::string why;  ///< there is none
};

/// Loads a library, which stays until the program ends.
/// @param library  its file's name; it is looked for in the program's run path, then in the system's folders
ModuleSymbol load_module_symbol(const char* library, const char* symbol);

}  // namespace fidservo
