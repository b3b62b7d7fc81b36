// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rules of CONTRIBUTING.md that can be checked on the text of files.
#include <string>
#include <vector>

namespace fidservo::house {

struct SourceFile {
    std::string path;  ///< from the top of the repository, e.g. "vision/camera.h"
    std::string text;
};

/// One line a finding: file, and what is wrong with it. Empty: clean.
using Findings = std::vector<std::string>;

/// All .h and .cpp files of the rooms, tests and benchmarks below `top`.
std::vector<SourceFile> read_house(const std::string& top);
/// All .md files in docs and at the top.
std::vector<SourceFile> read_documents(const std::string& top);

/// Includes that violate the order of rooms.
Findings forbidden_arrows(const SourceFile& file);

/// Includes within the diagnosis of a room that comes after the file's own.
Findings steps_up_in_gap(const SourceFile& file);
/// Includes of a command by lower parts, and folders of src that include each other in a circle. The folders
/// are those of a task (src/NAME with everything below it) and those of src/files.
Findings circles_in_src(const std::vector<SourceFile>& house);
/// Quoted includes that are not written from the top of the repository.
Findings includes_not_from_the_top(const SourceFile& file, const std::vector<SourceFile>& house);
/// Headers that show third-party types (Eigen, cv::Mat and tl::expected excepted) outside their own folder.
Findings leaking_third_party(const SourceFile& file, const std::vector<SourceFile>& house);
/// Files of a room without the room's namespace.
Findings wrong_namespace(const SourceFile& file);
/// Headers without #pragma once.
Findings unguarded_header(const SourceFile& file);
/// Files that do not begin with their licence's SPDX line.
Findings unlicensed(const SourceFile& file);
/// Files that are too long to be read in one sitting.
Findings too_long(const SourceFile& file);
/// Paths that exist on a particular machine only.
Findings machine_paths(const SourceFile& file);
/// Uses of the wall clock, which may be set at any moment, other than for the date of a log line or a
/// recording.
Findings wall_clocks(const SourceFile& file);
/// Tests that a document names, `Suite.Thing_Condition_Expectation`, and that no test file has.
Findings tests_that_are_not_there(const SourceFile& document, const std::vector<SourceFile>& house);
/// Code of the diagnosis that tests for an effect's name, its block or a parameter's unit instead of the
/// properties that the effect states (plant/effects/effect.h). Which block errors accuse is in
/// gap/residuals/accusation.cpp.
Findings effects_asked_for(const SourceFile& file, const std::vector<SourceFile>& house);
/// Notes on unfinished work, and code that is commented out.
Findings notes_to_self(const SourceFile& file);

}  // namespace fidservo::house
