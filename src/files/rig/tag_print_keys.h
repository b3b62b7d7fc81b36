// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the tags of a plate are printed: keys that plate files and rig files have in common.
#include "core/tag_families.h"
#include "src/files/text/yaml_reader.h"

#include <string>

namespace fidservo {

/// For messages.
std::string names_of_tag_families();

/// family, border_cells, inverted; each as usual where it is left out. Throws InputError.
TagPrint read_tag_print(const YamlValue& map);

/// An id of the family. Throws InputError that names the range.
int read_tag_id(const YamlValue& value, const TagPrint& print);

/// The same three keys as text "family: ..., border_cells: ...", those that are as usual left out but the
/// family.
std::string tag_print_yaml(const TagPrint& print, const std::string& separator);

}  // namespace fidservo
