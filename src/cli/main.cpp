// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/cli.h"
#include "src/process/interrupt.h"

#include <glog/logging.h>
#include <malloc.h>

namespace {

/// A diagnosis makes predictions of some MB by the thousand, on several threads. The allocator keeps what
/// they leave: given back to the system, every page is faulted in again, which takes as long as the
/// diagnosis. It keeps it for all threads, as what each kept for itself would add up.
void keep_freed_memory() {
    constexpr int mapped_from_bytes = 32 << 20, returned_from_bytes = 256 << 20;
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_MMAP_THRESHOLD, mapped_from_bytes);
    mallopt(M_TRIM_THRESHOLD, returned_from_bytes);
}

/// What Ceres has to say of its matrices is said in the program's own words, where it matters.
void pass_over_solver_messages() {
    FLAGS_minloglevel = google::GLOG_FATAL;
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    pass_over_solver_messages();
    fidservo::watch_for_interrupts();
    return fidservo::run_command_line(argc, argv);
}
