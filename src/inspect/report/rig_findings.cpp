// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/rig_findings.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/diagnose/diagnose_recordings.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/diagnose/report/report.h"
#include "src/diagnose/verdict_words.h"
#include "src/diagnose/words.h"
#include "src/files/disk/durable_file.h"
#include "src/files/recording/reader.h"
#include "src/process/interrupt.h"
#include "src/report/html.h"

#include <string>
#include <vector>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

std::vector<Recording> recordings_in(const OutputFolder& output) {
    std::vector<Recording> recordings;
    for (const std::filesystem::path& folder : find_recordings(output.root))
        recordings.push_back(read_recording(folder));
    return recordings;
}

RigFindings found(const gap::Diagnosis& diagnosis) {
    const std::string end = diagnosis.ended == gap::Ended::finished
                                ? ""
                                : fmt::format("<p>{}.</p>", diagnose::end_words(diagnosis.ended));
    std::string notes;
    for (const std::string& note : diagnosis.notes)
        notes += fmt::format("<li>{}</li>", report::escaped(note));
    return {
        fmt::format("rig: {} (diagnosis.html)", gap::name_of(diagnosis.verdict)),
        fmt::format("<p><strong>{}</strong> {}</p>{}<p>By what this run has recorded; what its moves cannot "
                    "show it cannot rule out. <a href=\"diagnosis.html\">The whole diagnosis</a>.</p>\n"
                    "<details><summary>What these recordings cannot show, and what was not "
                    "judged</summary><ul>{}</ul></details>\n",
                    report::escaped(diagnose::verdict_sentence(diagnosis)),
                    report::escaped(diagnose::verdict_detail(diagnosis)), end, notes)};
}

RigFindings nothing_found(const std::string& why) {
    return {fmt::format("rig: not diagnosed: {}", why), fmt::format("<p>{}</p>\n", report::escaped(why))};
}

}  // namespace

RigFindings find_in_recordings(const OutputFolder& output, const Rig& rig,
                               const std::filesystem::path& rig_file) {
    try {
        const diagnose::Conduct conduct{.is_brief = true, .interrupted = interrupt_requested};
        const auto [evidence, diagnosis, limit] =
            diagnose::diagnose_recordings(rig, {recordings_in(output), {}}, {}, conduct);
        evidence.budget()->end();
        replace_file(output.root / "diagnosis.json", diagnosis_json(diagnosis));
        replace_file(output.root / "diagnosis.html", diagnose::diagnosis_report(evidence, diagnosis,
                                                                                {.rig_file = rig_file,
                                                                                 .recordings = {output.root},
                                                                                 .only = {},
                                                                                 .without = {},
                                                                                 .written_rig = {}}));
        RigFindings findings = found(diagnosis);
        findings.diagnosis = diagnosis_json(diagnosis);
        return findings;
    } catch (const gap::BudgetEnded&) {
        return nothing_found("interrupted, or out of time, before anything was predicted");
    } catch (const InputError& error) {
        return nothing_found(error.what());
    }
}

}  // namespace fidservo::inspect
