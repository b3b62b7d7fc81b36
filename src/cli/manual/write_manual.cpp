// SPDX-License-Identifier: GPL-3.0-or-later
// write_manual FOLDER: the man pages, in FOLDER/man1, and the completion for bash, as FOLDER/fidservo.
#include "src/cli/cli.h"
#include "src/cli/manual/manual.h"
#include "src/process/commit.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace fidservo {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file << text;
    file.close();
}

void write_manual(const std::filesystem::path& folder) {
    int exit_code = 0;
    const auto program = make_command_line(exit_code);
    std::filesystem::create_directories(folder / "man1");
    for (const ManPage& page : man_pages(*program, program_version()))
        write(folder / "man1" / page.name, page.text);
    write(folder / "fidservo", bash_completion(*program));
}

}  // namespace
}  // namespace fidservo

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write_manual FOLDER\n", stderr);
        return 2;
    }
    try {
        fidservo::write_manual(argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "write_manual: %s: %s\n", argv[1], error.what());
        return 2;
    }
}
