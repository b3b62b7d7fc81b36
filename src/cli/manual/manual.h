// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The program's man pages and shell completion, made from the description of its commands that --help shows.
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace fidservo {

struct ManPage {
    std::string name;  ///< name of its file: fidservo-inspect.1
    std::string text;  ///< in roff, with the macros of man(7)
};

/// A page of the program and one of each command: fidservo.1, fidservo-inspect.1,
/// fidservo-calibrate-camera.1.
std::vector<ManPage> man_pages(const CLI::App& program, std::string_view version);

/// A script for bash that completes the program's commands and options. Elsewhere it completes file names.
std::string bash_completion(const CLI::App& program);

}  // namespace fidservo
