// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/next_steps.h"

#include "core/rig.h"
#include "src/diagnose/advice.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::diagnose {
namespace {

using report::escaped;

/// An argument as a POSIX shell reads it.
std::string shell_word(const std::string& text) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string command_html(const std::string& command) {
    return fmt::format("<pre class=\"command\">{}</pre>\n", escaped(command));
}

std::string diagnose_command(const Request& request, const std::string& more_recordings,
                             const std::string& options) {
    std::string command = fmt::format("fidservo diagnose --rig {}", shell_word(request.rig_file.string()));
    if (!request.only.empty()) command += fmt::format(" --effects {}", fmt::join(request.only, ","));
    if (!request.without.empty()) command += fmt::format(" --without {}", fmt::join(request.without, ","));
    for (const std::filesystem::path& recording : request.recordings)
        command += " " + shell_word(recording.string());
    return command + more_recordings + options;
}

std::string step_section(std::string_view heading, const std::string& html) {
    return fmt::format("<h3>{}</h3>\n{}", heading, html);
}

std::string experiment_html(const gap::ProposedExperiment& proposed, const Request& request) {
    std::vector<std::string> names;
    for (const std::string& name : proposed.separates) names.push_back(readable(name));
    const std::string rig = shell_word(request.rig_file.string());
    std::string html = fmt::format("<p>{}</p>\n", escaped(proposed.text));
    if (!names.empty()) html += fmt::format("<p>It tells apart: {}.</p>\n", escaped(enumerated(names)));
    html += "<p>See in the simulator what it commands, then record the same on the rig:</p>\n" +
            command_html(fmt::format(
                "fidservo simulate {} --rig {} --out simulated-{}", shell_word(proposed.experiment), rig,
                shell_word(std::filesystem::path(proposed.experiment).stem().string()))) +
            "<p>Then diagnose again, with the new recording beside the others:</p>\n" +
            command_html(diagnose_command(request, " NEW-RECORDING", " --report REPORT.html"));
    return html;
}

/// How wrong the simulator stays at the signals that are off their floor.
std::string trust_html(const gap::Diagnosis& diagnosis, const Rig& rig) {
    std::vector<std::string> sizes;
    for (const gap::SignalGap& signal : diagnosis.signals)
        if (size_class(signal.after / signal.floor) > 0)
            sizes.push_back(
                fmt::format("{} in the {} (before: {})", shown_size(rig, signal.signal, signal.after),
                            signal_words(signal.signal), shown_size(rig, signal.signal, signal.before)));
    if (sizes.empty()) return "";
    return fmt::format("<p>Until the cause is found, predictions over one second are off by {}, r.m.s.</p>\n",
                       escaped(enumerated(sizes)));
}

std::string remainder_html(const gap::Remainder& remainder) {
    std::string html = fmt::format("<p>{}.</p>\n", escaped(capitalised(remainder.text)));
    std::string hints;
    for (const std::string& dependence : remainder.depends_on) {
        const std::string_view advice = advice_on_dependence(dependence);
        if (!advice.empty())
            hints += fmt::format("<li><strong>{}</strong>: {}</li>\n",
                                 escaped(capitalised(dependence_words(dependence))), escaped(advice));
    }
    if (!hints.empty())
        html += fmt::format("<p>Look first at {}:</p>\n<ul>{}</ul>\n", block_words(remainder.block), hints);
    return html;
}

std::string equation_html(const gap::Equation& equation) {
    std::string rows;
    for (const gap::FittedParameter& parameter : equation.parameters)
        rows += fmt::format("<tr><td>{}</td><td>{:.6g} \u00b1 {:.2g}</td><td>{}</td></tr>\n",
                            escaped(parameter.name), parameter.value, parameter.std, escaped(parameter.unit));
    const std::string elsewhere =
        equation.gap_removed_of_kinds_left_out
            ? fmt::format(
                  " Of experiments of a kind that it was not fitted to, each kind predicted from the "
                  "others, it removes {:.1f} %.",
                  100.0 * *equation.gap_removed_of_kinds_left_out)
            : std::string();
    return fmt::format(
        "<p>An equation for it, proposed by these recordings and by nothing else, and added at "
        "<code>{}</code>:</p>\n"
        "<pre "
        "class=\"command\">{}</pre>\n<table><thead><tr><th>parameter</th><th>value</th><th>unit</th></tr></"
        "thead>"
        "<tbody>\n{}</tbody></table>\n<p>It removes {:.1f} % (95 %: {:.1f} to {:.1f} %) of {}, on windows "
        "that it was "
        "not fitted to.{} {}</p>\n",
        escaped(equation.acts_on), escaped(equation.formula), rows, 100.0 * equation.gap_removed,
        100.0 * equation.gap_removed_low, 100.0 * equation.gap_removed_high,
        equation.in_place_of_names
            ? "the whole gap, in place of the effects named, than which it predicts better"
            : "what is left",
        elsewhere, escaped(equation.text));
}

std::string closing_html(const Request& request) {
    std::string html;
    std::string rig = "RIG-AS-FOUND.yaml";
    if (request.written_rig.empty()) {
        html +=
            "<p>Where the cause stays, let the simulator have it: this writes a copy of the rig file with "
            "the effects and their values.</p>\n" +
            command_html(diagnose_command(request, "", " --write-rig " + rig));
    } else {
        rig = shell_word(request.written_rig.string());
        html += fmt::format(
            "<p>Where the cause stays, let the simulator have it: <code>{}</code> is the rig file with the "
            "effects and their values.</p>\n",
            escaped(request.written_rig.string()));
    }
    return html + "<p>Every command that takes a rig file then simulates with them, for example:</p>\n" +
           command_html(fmt::format("fidservo simulate campaign --rig {} --out simulated-as-found", rig));
}

std::string notes_html(const std::vector<std::string>& notes) {
    constexpr std::size_t few = 12;
    std::string html;
    for (const std::string& note : notes) html += fmt::format("<li>{}</li>\n", escaped(note));
    html = "<ul class=\"notes\">" + html + "</ul>\n";
    if (notes.size() <= few) return html;
    return fmt::format("<details><summary>{} remarks</summary>\n{}</details>\n", notes.size(), html);
}

std::string no_gap_html(const gap::Diagnosis& diagnosis) {
    if (diagnosis.signals.empty())
        return "<p>Record the experiments again: ten seconds and more each, a command and a reading in every "
               "row.</p>\n";
    if (size_class(diagnosis.gap.before) > 0)
        return "<p>The predictions are off by more than the sensors' noise, but too few windows say so to "
               "decide on a cause. Record the experiments again, longer and several times each, and repeat "
               "the diagnosis.</p>\n";
    return "<p>For what the recordings exercise nothing needs to be done: use the simulator as it is. An "
           "effect that they do not excite (a place on the rail, a speed, a temperature) does not show; "
           "which those are stands below. When the rig was changed or has aged, record again and repeat "
           "the diagnosis.</p>\n";
}

}  // namespace

std::string next_steps_html(const gap::Diagnosis& diagnosis, const Rig& rig, const Request& request) {
    std::string html;
    if (diagnosis.verdict == gap::Verdict::no_gap) html += no_gap_html(diagnosis);
    if (!diagnosis.effects.empty())
        html += fmt::format(
            "<p>Check on the rig what was found, as the cards above say, before you change anything: a model "
            "that predicts well is a strong hint, and an inspection is the proof.</p>\n");
    if (diagnosis.next_experiment)
        html +=
            step_section("An experiment that decides", experiment_html(*diagnosis.next_experiment, request));
    const gap::Equation* equation = gap::proposed_equation(diagnosis);
    if (diagnosis.unexplained)
        html += step_section("What no known effect explains",
                             remainder_html(*diagnosis.unexplained) +
                                 (equation != nullptr ? equation_html(*equation) : "") +
                                 trust_html(diagnosis, rig));
    if (!diagnosis.effects.empty() || equation != nullptr)
        html += step_section("How to close the gap", closing_html(request));
    if (!diagnosis.notes.empty()) html += step_section("What cannot be decided", notes_html(diagnosis.notes));
    return html;
}

}  // namespace fidservo::diagnose
