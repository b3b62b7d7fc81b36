// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a diagnosis made by hand, over recordings of the simulated rig.
#include "src/diagnose/report/report.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/diagnose/report/predictions.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"
#include "tests/diagnose/well_formed.h"
#include "tests/gap/effects.h"
#include "tests/gap/root_mean_square.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::diagnose {
namespace {

using ::fidservo::testing::effects;
using ::fidservo::testing::nesting_fault;
using ::fidservo::testing::rms;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint64_t seed = 5;

std::vector<Recording> simulated(const Rig& rig, const gap::Hypothesis& truth,
                                 std::initializer_list<std::string_view> kinds) {
    std::vector<Recording> recordings;
    for (const std::string_view kind : kinds) {
        const std::string name = "<b>" + std::string(kind) + "</b>";
        recordings.push_back(simulate(rig, truth, make_experiment(kind, rig, seed, name), name, seed));
    }
    return recordings;
}

const gap::Evidence& evidence() {
    static const gap::Evidence made(
        reference_rig(),
        simulated(reference_rig(), effects({"hall_gain:factor=1.05"}), {"micro-servo", "integrated"}));
    return made;
}

gap::Diagnosis hall_gain_found() {
    gap::Diagnosis diagnosis;
    diagnosis.verdict = gap::Verdict::explained;
    diagnosis.signals = {{gap::Signal::encoder, 0.31, 0.31, 0.30}, {gap::Signal::hall, 23.4, 0.66, 0.65}};
    diagnosis.gap = {25.6, 1.02};
    diagnosis.where = {{"micro.hall", 0.93}};
    diagnosis.effects = {{.effect = "hall_gain",
                          .block = "micro.hall",
                          .probability = 0.913,
                          .parameters = {{"factor", "", 1.04987, 0.00021}},
                          .indistinguishable_from = {"stroke_change"},
                          .gap_removed = 0.987,
                          .gap_removed_low = 0.951,
                          .gap_removed_high = 0.992}};
    diagnosis.candidates = {{"hall_gain", "micro.hall", 0.913, 0.987},
                            {"hall_offset", "micro.hall", 0.0123, 0.456},
                            {"hall_drift", "micro.hall", 1e-9, 0.0}};
    diagnosis.next_experiment =
        gap::ProposedExperiment{"micro-triangle", {"hall_gain", "stroke_change"}, "Sweep <slowly>."};
    diagnosis.notes = {"rest-1: encoder: <i>not judged</i>"};
    diagnosis.hypothesis = effects({"hall_gain:factor=1.05"});
    return diagnosis;
}

const Request request{"my rig.yaml", {"campaign"}, {"hall_gain", "hall_offset"}, {}, {}};

TEST(DiagnosisReport, Numbers_AreTheDiagnosiss) {
    const std::string html = diagnosis_report(evidence(), hall_gain_found(), request);
    for (const char* expected :
         {"25.6", "1.02", "93.0 %", "91.3 %", "98.7 %", "95.1 %", "99.2 %", "1.04987 \u00b1 0.00021",
          "45.6 %", "1.2 %", "23.4 LSB", "--effect hall_gain:factor=1.05", "micro-triangle"})
        EXPECT_THAT(html, HasSubstr(expected)) << expected;
}

TEST(DiagnosisReport, Texts_CannotBecomeMarkup) {
    const std::string html = diagnosis_report(evidence(), hall_gain_found(), request);
    for (const char* raw : {"<b>micro-servo", "<slowly>", "<i>not judged"})
        EXPECT_THAT(html, Not(HasSubstr(raw)));
    EXPECT_THAT(html, HasSubstr("&lt;b&gt;micro-servo&lt;/b&gt;"));
    EXPECT_THAT(html, HasSubstr("Sweep &lt;slowly&gt;."));
}

TEST(NestingFault, WrongNesting_IsSeen) {
    EXPECT_EQ(nesting_fault("<p>a<br>b <b>c</b><i/></p>"), "");
    for (const char* wrong : {"<p><b></p></b>", "<p>", "</p>", "<td>< 0.1 %</td>"})
        EXPECT_NE(nesting_fault(wrong), "") << wrong;
}

TEST(DiagnosisReport, File_IsWellFormedSmallAndLoadsNothing) {
    constexpr std::size_t largest = 3'000'000;
    const std::string html = diagnosis_report(evidence(), hall_gain_found(), request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_LT(html.size(), largest);
    for (const char* link : {"src=\"http", "href=\"http", "url(http", "@import", "<link"})
        EXPECT_THAT(html, Not(HasSubstr(link)));
}

TEST(DiagnosisReport, Commands_CanBePastedIntoAShell) {
    const std::string html = diagnosis_report(evidence(), hall_gain_found(), request);
    EXPECT_THAT(html, HasSubstr("fidservo diagnose --rig &#39;my rig.yaml&#39; --effects "
                                "hall_gain,hall_offset campaign --write-rig RIG-AS-FOUND.yaml"));
    Request written = request;
    written.written_rig = "found.yaml";
    EXPECT_THAT(diagnosis_report(evidence(), hall_gain_found(), written),
                HasSubstr("fidservo simulate campaign --rig found.yaml"));
}

TEST(DiagnosisReport, NoGap_SaysSoAndProposesNoCure) {
    gap::Diagnosis diagnosis = hall_gain_found();
    diagnosis.verdict = gap::Verdict::no_gap;
    diagnosis.effects.clear();
    diagnosis.where.clear();
    diagnosis.hypothesis.clear();
    diagnosis.next_experiment.reset();
    diagnosis.gap = {1.01, 1.01};
    const std::string html = diagnosis_report(evidence(), diagnosis, request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_THAT(html, HasSubstr("<h1>No gap was found"));
    for (const char* absent :
         {"id=\"waterfall\"", "id=\"found\"", "--write-rig", "with the explanation", "block accused"})
        EXPECT_THAT(html, Not(HasSubstr(absent))) << absent;
}

TEST(DiagnosisReport, RecordingTooShortToBeJudged_IsNotCalledFreeOfGaps) {
    std::vector<Recording> recordings = simulated(reference_rig(), {}, {"rest"});
    recordings.front().rows.resize(50);
    recordings.front().detections.clear();
    const gap::Evidence nothing(reference_rig(), std::move(recordings));
    ASSERT_TRUE(nothing.windows().empty());
    const std::string html = diagnosis_report(nothing, {}, request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_THAT(html, HasSubstr("<h1>Nothing in these recordings could be judged"));
    EXPECT_THAT(html, Not(HasSubstr("No gap")));
}

TEST(DiagnosisReport, Unexplained_SaysWhereAndWhatItDependsOn) {
    gap::Diagnosis diagnosis = hall_gain_found();
    diagnosis.verdict = gap::Verdict::unexplained;
    diagnosis.effects.clear();
    diagnosis.hypothesis.clear();
    diagnosis.unexplained = gap::Remainder{"micro.hall", {"contraction"}, "hall: 23.4 adc r.m.s. remain"};
    diagnosis.signals[1].after = diagnosis.signals[1].before;
    const std::string html = diagnosis_report(evidence(), diagnosis, request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_THAT(html, HasSubstr("the Hall sensor, dependent on contraction; no known effect explains it"));
    EXPECT_THAT(html, HasSubstr("Hall: 23.4 adc r.m.s. remain."));
    EXPECT_THAT(html, HasSubstr("<figure class=\"dependence named\">"));
    EXPECT_THAT(
        html,
        HasSubstr("predictions over one second are off by 23.4 LSB in the Hall reading (before: 23.4 LSB)"));
}

TEST(DiagnosisReport, Equation_IsShownWithItsParametersAndWritten) {
    gap::Diagnosis diagnosis = hall_gain_found();
    diagnosis.verdict = gap::Verdict::unexplained;
    diagnosis.effects.clear();
    diagnosis.hypothesis.clear();
    gap::Equation equation{.acts_on = "micro.heat_flow",
                           .formula = "a * contraction_rate",
                           .variables = {"contraction_rate"},
                           .parameters = {{"a", "degC/mm", -2.0, 0.01}},
                           .gap_removed = 0.97,
                           .gap_removed_low = 0.95,
                           .gap_removed_high = 0.98,
                           .text = "As latent heat is.",
                           .setting = {}};
    diagnosis.unexplained =
        gap::Remainder{"micro.heater", {"contraction"}, "hall: 23.4 adc r.m.s. remain", equation};
    const std::string html = diagnosis_report(evidence(), diagnosis, request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_THAT(html, HasSubstr("a * contraction_rate"));
    EXPECT_THAT(html, HasSubstr("It removes 97.0 % (95 %: 95.0 to 98.0 %) of what is left"));
    EXPECT_THAT(html, HasSubstr("As latent heat is."));
    EXPECT_THAT(html, HasSubstr("--write-rig"));
}

TEST(DiagnosisReport, RigWithCarriageAlone_SpeaksOfNothingElse) {
    Rig rig = reference_rig();
    rig.micro.reset();
    rig.camera.reset();
    rig.fiducials.reset();
    const gap::Evidence carriage(rig, simulated(rig, effects({"payload"}), {"macro-pulses"}));
    gap::Diagnosis diagnosis;
    diagnosis.verdict = gap::Verdict::unexplained;
    diagnosis.signals = {{gap::Signal::encoder, 9.0, 9.0, 0.3}};
    diagnosis.gap = {30.0, 30.0};
    diagnosis.unexplained = gap::Remainder{"macro.friction", {"velocity"}, "encoder: much remains"};
    const std::string html = diagnosis_report(carriage, diagnosis, request);
    EXPECT_EQ(nesting_fault(html), "");
    EXPECT_THAT(html, HasSubstr("carriage velocity, mm/s"));
    for (const char* absent : {"Hall reading", "Tags in the image", "heater command", "nan"})
        EXPECT_THAT(html.substr(0, html.find("<script>")), Not(HasSubstr(absent))) << absent;
}

/// The values of a trace of the page's plots.
std::vector<float> trace_values(const std::string& html, const std::string& plot, std::size_t trace) {
    const std::string opening = "data-traces=\"" + plot + "\">";
    const std::size_t begin = html.find(opening) + opening.size();
    const auto json = nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
    const std::string text = json["traces"].at(trace)["data"];
    static const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<unsigned char> bytes;
    unsigned bits = 0;
    for (std::size_t i = 0; i < text.size() && text[i] != '='; ++i) {
        bits = bits << 6 | static_cast<unsigned>(alphabet.find(text[i]));
        if (i % 4 != 0) bytes.push_back(static_cast<unsigned char>(bits >> (6 - 2 * (i % 4)) & 0xffu));
    }
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
}

float largest(const std::vector<float>& values) {
    float found = 0.0f;
    for (const float value : values)
        if (!std::isnan(value)) found = std::max(found, std::abs(value));
    return found;
}

TEST(DiagnosisReport, Traces_ShowTheErrorsOfTheWorstRecording) {
    const gap::Diagnosis diagnosis = hall_gain_found();
    const std::string html = diagnosis_report(evidence(), diagnosis, request);
    const auto wanted = gap::everything(evidence());
    const gap::Errors before = evidence().errors({}, wanted),
                      after = evidence().errors(diagnosis.hypothesis, wanted);
    const std::size_t worst =
        rms(evidence(), before, gap::Signal::hall, 0) > rms(evidence(), before, gap::Signal::hall, 1) ? 0 : 1;
    for (const auto& [trace, errors] : {std::pair(0u, &before), std::pair(1u, &after)}) {
        float expected = 0.0f;
        for (const gap::Window& window : evidence().windows())
            if (window.signal == gap::Signal::hall && window.run == worst)
                expected =
                    std::max(expected, largest({errors->begin() + static_cast<std::ptrdiff_t>(window.begin),
                                                errors->begin() + static_cast<std::ptrdiff_t>(window.end)}));
        const auto floor = static_cast<float>(evidence().floor(gap::Signal::hall));
        EXPECT_FLOAT_EQ(largest(trace_values(html, "traces-hall-errors", trace)), expected * floor)
            << "trace " << trace;
    }
}

TEST(Predictions, GapsByRun_AreRootMeanSquares) {
    const Predictions predictions = predict(evidence(), effects({"hall_gain:factor=1.05"}));
    const std::vector<RunGaps> gaps = gaps_by_run(evidence(), predictions);
    ASSERT_EQ(gaps.size(), 2u);
    for (std::size_t run = 0; run < gaps.size(); ++run) {
        const RunGap& hall = gaps[run][gap::index_of(gap::Signal::hall)];
        EXPECT_DOUBLE_EQ(hall.before, rms(evidence(), predictions.nominal, gap::Signal::hall, run));
        EXPECT_DOUBLE_EQ(hall.after, rms(evidence(), predictions.explained, gap::Signal::hall, run));
        EXPECT_GT(hall.before, 3.0 * hall.after) << "seed " << seed;
    }
}

TEST(Predictions, RefusedHypothesis_IsNoExplanation) {
    const Predictions predictions =
        predict(evidence(), effects({"airflow:factor=0.8", "airflow:factor=0.9"}));
    EXPECT_FALSE(predictions.is_explained);
    EXPECT_EQ(predictions.explained.size(), predictions.nominal.size());
}

}  // namespace
}  // namespace fidservo::diagnose
