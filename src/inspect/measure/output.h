// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files and folders of a run.
#include <filesystem>
#include <string>

namespace fidservo::inspect {

/// OUT/journal.jsonl, results.csv, run.json, report.html, images/, recordings/.
struct OutputFolder {
    std::filesystem::path root;

    std::filesystem::path journal() const { return root / "journal.jsonl"; }
    std::filesystem::path results() const { return root / "results.csv"; }
    std::filesystem::path run_json() const { return root / "run.json"; }
    std::filesystem::path report() const { return root / "report.html"; }
};

/// "site-012", and "site-012-again" for the second visit.
std::string visit_name(int tag_id, bool again);
/// "images/site-012-left.png", relative to the output folder.
std::string image_name(int tag_id, bool again, const std::string& view);
/// "recordings/site-012", relative to the output folder.
std::string recording_name(int tag_id, bool again);

}  // namespace fidservo::inspect
