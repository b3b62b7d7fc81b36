// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the tags of a plate are printed: keys that plate files and rig files share.
#include "core/tag_families.h"
#include "src/files/text/yaml_reader.h"

#include <string>

namespace fidservo {

/// The names of all families, for messages.
std::string names_of_tag_families();

/// Reads family, border_cells and inverted; those left out have their defaults. Throws InputError.
TagPrint read_tag_print(const YamlValue& map);

/// Reads an id of the family. Throws InputError that names the range.
int read_tag_id(const YamlValue& value, const TagPrint& print);

/// The same three keys as text "family: ..., border_cells: ..."; except for the family, those with default
/// values are left out.
std::string tag_print_yaml(const TagPrint& print, const std::string& separator);

}  // namespace fidservo
