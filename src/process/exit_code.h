// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo {

/// What the program's end tells a script.
enum ExitCode : int {
    exit_done = 0,
    exit_answer_is_no = 1,  ///< done, but an inspection failed or a target was not reached
    exit_wrong_input = 2,
    exit_fault = 3,  ///< of a device or of the run
};

}  // namespace fidservo
