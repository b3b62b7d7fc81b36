// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo {

/// Exit codes of the program.
enum ExitCode : int {
    exit_done = 0,
    exit_answer_is_no = 1,  ///< completed, but an inspection failed or a target was not reached
    exit_wrong_input = 2,
    exit_fault = 3,  ///< failure of a device or of the run
};

}  // namespace fidservo
