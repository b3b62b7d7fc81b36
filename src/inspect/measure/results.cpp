// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/results.h"

#include "src/files/disk/durable_file.h"

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

/// RFC 4180: quoted where it must be.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + "\"";
}

std::string field(const std::optional<double>& value) {
    if (!value) return {};
    const std::string text = fmt::format("{:.3f}", *value);
    return text == "-0.000" ? "0.000" : text;
}

int severity(Outcome outcome) {
    switch (outcome) {
        case Outcome::pass:
            return 0;
        case Outcome::not_decidable:
            return 1;
        case Outcome::not_measured:
            return 2;
        case Outcome::fail:
            return 3;
    }
    return 3;
}

}  // namespace

std::string_view name_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::pass:
            return "pass";
        case Outcome::fail:
            return "fail";
        case Outcome::not_decidable:
            return "not_decidable";
        case Outcome::not_measured:
            return "not_measured";
    }
    return "";
}

std::string_view name_of(Visit::End end) {
    switch (end) {
        case Visit::End::measured:
            return "measured";
        case Visit::End::skipped:
            return "skipped";
        case Visit::End::deferred:
            return "deferred";
    }
    return "";
}

Outcome outcome_of(vision::Verdict verdict) {
    switch (verdict) {
        case vision::Verdict::pass:
            return Outcome::pass;
        case vision::Verdict::fail:
            return Outcome::fail;
        case vision::Verdict::not_decidable:
            return Outcome::not_decidable;
    }
    return Outcome::not_decidable;
}

Outcome worse(Outcome a, Outcome b) {
    return severity(a) >= severity(b) ? a : b;
}

Counts count(const std::vector<Visit>& visits) {
    Counts counts;
    for (const Visit& visit : visits)
        for (const ResultRow& row : visit.rows) switch (row.verdict) {
                case Outcome::pass:
                    ++counts.pass;
                    break;
                case Outcome::fail:
                    ++counts.fail;
                    break;
                case Outcome::not_decidable:
                    ++counts.not_decidable;
                    break;
                case Outcome::not_measured:
                    ++counts.not_measured;
                    break;
            }
    return counts;
}

Outcome outcome_of(const Visit& visit) {
    Outcome outcome = visit.end == Visit::End::measured ? Outcome::pass : Outcome::not_measured;
    for (const ResultRow& row : visit.rows) outcome = worse(outcome, row.verdict);
    return outcome;
}

std::string results_csv(const std::vector<Visit>& visits) {
    std::string csv =
        "site,view,check,feature,value,unit,uncertainty,nominal,tolerance,verdict,reason,image\n";
    for (const Visit& visit : visits)
        for (const ResultRow& row : visit.rows)
            csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", row.site, field(row.view),
                               field(row.check), field(row.feature), field(row.value), field(row.unit),
                               field(row.uncertainty), field(row.nominal), field(row.tolerance),
                               name_of(row.verdict), field(row.reason), field(row.image));
    return csv;
}

void write_results(const std::filesystem::path& file, const std::vector<Visit>& visits) {
    replace_file(file, results_csv(visits));
}

}  // namespace fidservo::inspect
