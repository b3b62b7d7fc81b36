// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/commands.h"

#include "core/rig.h"
#include "src/files/rig/rig_file.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace fidservo {

void add_rig_option(CLI::App& command, std::filesystem::path& rig_file) {
    rig_file = reference_rig_file();
    command.add_option("--rig", rig_file, "Rig file; the reference rig if not given")->type_name("RIG.yaml");
}

void add_example(CLI::App& command, const std::string& example) {
    command.footer("Example:\n  " + example);
}

}  // namespace fidservo
