// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// diagnose --self-check: the options that it adds to the command, and what it then does.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace fidservo {

struct SelfCheckRequest {
    bool wanted = false;
    std::size_t cases = 300;
    std::uint64_t seed = 1;
    std::size_t first = 0;
    std::vector<std::string> kinds;
    std::vector<std::string> recordings;
    bool settles_ties = false, by_effort = false;
};

void add_self_check_options(CLI::App& diagnose, SelfCheckRequest& request);

/// Prints a line a case and the tally. @param json  new file; empty: none
/// @return exit_answer_is_no where a figure misses its limit; of a run that was interrupted, too
int run_self_check(const SelfCheckRequest& request, const std::filesystem::path& rig_file,
                   const std::vector<std::string>& only, const std::filesystem::path& json);

}  // namespace fidservo
