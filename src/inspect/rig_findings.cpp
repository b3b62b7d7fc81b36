#include "src/inspect/rig_findings.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/tag_link.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/diagnose/report.h"
#include "src/diagnose/verdict_words.h"
#include "src/diagnose/words.h"
#include "src/interrupt.h"
#include "src/recording/durable_file.h"
#include "src/recording/reader.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

/// Whether a recipe's plate has a tag where the rig file has it.
bool is_where_the_rig_has_it(const Recipe& recipe, const FiducialParameters& fiducials, int id) {
    constexpr double same_mm = 1e-6, same_rad = 1e-9;
    const PlateTag* tag = find_tag(recipe.nominal, id);
    const auto centre_mm = gap::tag_centre_mm(fiducials, id);
    return tag != nullptr && centre_mm && (tag->centre_mm - *centre_mm).norm() < same_mm &&
           std::abs(tag->side_mm - fiducials.side_mm) < same_mm && std::abs(tag->angle_rad) < same_rad;
}

std::vector<Recording> recordings_of(const OutputFolder& output, const Recipe& recipe, const Rig& rig) {
    std::vector<Recording> recordings;
    for (const std::filesystem::path& folder : find_recordings(output.root)) {
        recordings.push_back(read_recording(folder));
        std::erase_if(recordings.back().detections, [&](const TagDetection& detection) {
            return !is_where_the_rig_has_it(recipe, *rig.fiducials, detection.tag_id);
        });
    }
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

RigFindings find_in_recordings(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                               const std::filesystem::path& rig_file) {
    if (!rig.fiducials) return nothing_found("the rig file has no fiducials");
    constexpr double search_s = 20.0, whole_s = 26.0;
    const auto budget = std::make_shared<const gap::Budget>(search_s, whole_s, interrupt_requested);
    try {
        const gap::Evidence evidence(rig, recordings_of(output, recipe, rig), budget);
        const gap::Diagnosis diagnosis = gap::diagnose(evidence);
        budget->end();
        replace_file(output.root / "diagnosis.json", diagnosis_json(diagnosis));
        replace_file(output.root / "diagnosis.html", diagnose::diagnosis_report(evidence, diagnosis,
                                                                                {.rig_file = rig_file,
                                                                                 .recordings = {output.root},
                                                                                 .only = {},
                                                                                 .without = {},
                                                                                 .written_rig = {}}));
        return found(diagnosis);
    } catch (const gap::BudgetEnded&) {
        return nothing_found("interrupted, or out of time, before anything was predicted");
    } catch (const InputError& error) {
        return nothing_found(error.what());
    }
}

}  // namespace fidservo::inspect
