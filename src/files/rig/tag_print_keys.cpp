// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/tag_print_keys.h"

#include <fmt/format.h>

namespace fidservo {

std::string names_of_tag_families() {
    return "tag36h11, tag25h9, tag16h5, tagStandard41h12, or DICT_NXN_M with N from 4 to 7 and M 50, 100, "
           "250 or 1000";
}

TagPrint read_tag_print(const YamlValue& map) {
    TagPrint print;
    if (const auto name = map.find("family")) {
        print.family = find_tag_family(name->text());
        if (print.family == nullptr) name->fail("must be one of " + names_of_tag_families());
    }
    if (const auto border = map.find("border_cells")) {
        print.border_cells = border->integer(1, 2);
        if (print.border_cells == 2 && !print.family->has_plain_border())
            border->fail(fmt::format("must be 1: {} has no plain border to make wider", print.family->name));
    }
    if (const auto inverted = map.find("inverted")) print.inverted = inverted->boolean();
    return print;
}

int read_tag_id(const YamlValue& value, const TagPrint& print) {
    const int last = print.family->size() - 1;
    const std::int64_t id = value.whole_number();
    if (id < 0 || id > last)
        value.fail(fmt::format("must be 0 to {}, the tags of {}", last, print.family->name));
    return static_cast<int>(id);
}

std::string tag_print_yaml(const TagPrint& print, const std::string& separator) {
    std::string text = fmt::format("family: {}", print.family->name);
    if (print.border_cells != 1) text += fmt::format("{}border_cells: {}", separator, print.border_cells);
    if (print.inverted) text += separator + "inverted: true";
    return text;
}

}  // namespace fidservo
