// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results of an inspection: rows of measurements, the outlines measured in images, and the course of each
// visit.
#include "vision/features/verdict.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::inspect {

/// The outcome of a check. The first three are guarded decisions (vision/features/verdict.h).
enum class Outcome { pass, fail, not_decidable, not_measured };

/// The word in result files: "pass", "fail", "not_decidable", "not_measured".
std::string_view name_of(Outcome outcome);
Outcome outcome_of(vision::Verdict verdict);
/// The worse of two: fail, not_measured, not_decidable, pass.
Outcome worse(Outcome a, Outcome b);

/// One row of results.csv. Numbers that do not apply are empty.
struct ResultRow {
    int site;  ///< id of its fiducial
    std::string view;
    std::string check;
    std::string feature;
    std::optional<double> value;
    std::string unit;
    std::optional<double> uncertainty;  ///< standard uncertainty
    std::optional<double> nominal;
    std::optional<double> tolerance;
    Outcome verdict;
    std::string reason;
    std::string image;  ///< relative to the output folder
};

/// Something drawn over an image: an open or closed outline, px.
struct Overlay {
    enum class Kind { fiducial, feature, defect };
    Kind kind;
    Outcome outcome;
    bool closed;
    std::vector<Eigen::Vector2d> points_px;
    std::string label;
};

struct ViewResult {
    std::string view;
    std::string image;
    double axis_x_mm, axis_y_mm;  ///< plate point under the optical axis
    std::vector<Overlay> overlays;
};

/// A failed attempt at a site.
struct FailedAttempt {
    std::string view;    ///< the view at which it failed; empty: during a motion
    std::string reason;  ///< name of the Reason
    std::string text;
};

/// One visit to a site: from the command to go there until it is measured, skipped or put off.
struct Visit {
    enum class End { measured, skipped, deferred };
    int site;
    bool again;  ///< the second visit, after all other sites
    End end;
    std::vector<FailedAttempt> failures;
    std::vector<ResultRow> rows;
    std::vector<ViewResult> views;
    std::string recording;  ///< relative to the output folder
    double from_s, to_s;    ///< on the rig's clock
    double macro_time_s, micro_time_s;
};

std::string_view name_of(Visit::End end);

/// The number of rows for each outcome.
struct Counts {
    int pass = 0, fail = 0, not_decidable = 0, not_measured = 0;
    int total() const { return pass + fail + not_decidable + not_measured; }
};
Counts count(const std::vector<Visit>& visits);

/// The worst outcome of a visit's rows.
Outcome outcome_of(const Visit& visit);

/// Writes results.csv: site, view, check, feature, value, unit, uncertainty, nominal, tolerance, verdict,
/// reason, image. Deferred visits have no rows: their second visit has. Throws RunFault if the disk does not
/// take it.
void write_results(const std::filesystem::path& file, const std::vector<Visit>& visits);

/// The text of that file.
std::string results_csv(const std::vector<Visit>& visits);

}  // namespace fidservo::inspect
