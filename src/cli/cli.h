// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

namespace CLI {
class App;
}

namespace fidservo {

/// All commands of the program, with their options. Parsing a command line with it runs the command and sets
/// the exit code.
std::unique_ptr<CLI::App> make_command_line(int& exit_code);

/// The program: reads the command line, runs the command, and turns whatever ends it into an exit code and at
/// most one line on stderr, "fidservo: ...".
int run_command_line(int argc, const char* const* argv);

}  // namespace fidservo
