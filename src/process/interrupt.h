// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ctrl-C and similar signals: a request to end the run in order at its next tick, with all measurements on
// disk and both stage commands zero.

namespace fidservo {

/// From now on SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is gone) only set a flag. A second SIGINT
/// ends the program at once with exit code 130; the guardian then sets the stage commands to zero. SIGHUP
/// stays ignored where it is ignored already (nohup). A reader of stdout that goes away (`| head`) does not
/// end a run.
void watch_for_interrupts();

/// True once one of these signals came. Cheap enough for every tick.
bool interrupt_requested() noexcept;

/// Has the effect of one Ctrl-C; may be called from any thread.
void request_interrupt() noexcept;

/// The name of the signal that requested the end, e.g. "SIGINT"; empty before that.
const char* interrupt_name() noexcept;

}  // namespace fidservo
