#pragma once

namespace fidservo {

/// The program: reads the command line, runs the command, and turns whatever ends it into an exit code and at
/// most one line on stderr, "fidservo: ...".
int run_command_line(int argc, const char* const* argv);

}  // namespace fidservo
