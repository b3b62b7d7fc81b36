// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// diagnose --self-check: its options and its run.
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

/// Prints a line for each case, and the statistics. @param json  new file; empty: none
/// @return exit_answer_is_no where a figure misses its limit, also after an interrupt
int run_self_check(const SelfCheckRequest& request, const std::filesystem::path& rig_file,
                   const std::vector<std::string>& only, const std::filesystem::path& json);

}  // namespace fidservo
