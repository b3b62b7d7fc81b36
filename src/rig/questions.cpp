// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/rig/questions.h"

#include <cmath>
#include <sstream>
#include <string>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// All that a line holds, as a number; throws nothing.
bool read_all(std::istringstream& line, auto&... values) {
    const bool are_read = static_cast<bool>((line >> ... >> values));
    return are_read && (line >> std::ws).eof();
}

std::istringstream without_commas(std::string text) {
    for (char& letter : text)
        if (letter == ',') letter = ' ';
    return std::istringstream(text);
}

class Interview {
  public:
    Interview(const std::function<bool(std::string_view)>& is_given, std::istream& answers,
              std::ostream& questions)
        : is_given_(is_given), answers_(answers), questions_(questions) {}

    void word(std::string_view option, std::string_view question, std::string& value) {
        ask(option, question, value, [&](const std::string& answer) {
            value = answer;
            return true;
        });
    }

    void kind(RigKind& value) {
        ask("--kind", "axis, camera (an axis, a camera and fiducials) or full (a micro stage too)?", "full",
            [&](const std::string& answer) {
                if (answer != "axis" && answer != "camera" && answer != "full") return false;
                value = answer == "axis"     ? RigKind::axis
                        : answer == "camera" ? RigKind::camera
                                             : RigKind::full;
                return true;
            });
    }

    void positive(std::string_view option, std::string_view question, double& value) {
        ask(option, question, fmt::format("{:g}", value), [&](const std::string& answer) {
            std::istringstream line(answer);
            double number = 0.0;
            if (!read_all(line, number) || !std::isfinite(number) || number <= 0.0) return false;
            value = number;
            return true;
        });
    }

    void range(std::string_view option, std::string_view question, std::array<double, 2>& value) {
        ask(option, question, fmt::format("{:g},{:g}", value[0], value[1]), [&](const std::string& answer) {
            std::istringstream line = without_commas(answer);
            double low = 0.0, high = 0.0;
            if (!read_all(line, low, high) || !std::isfinite(high - low) || low >= high) return false;
            value = {low, high};
            return true;
        });
    }

  private:
    void ask(std::string_view option, std::string_view question, const std::string& otherwise,
             const std::function<bool(const std::string&)>& take) {
        if (is_given_(option)) return;
        std::string answer;
        do {
            questions_ << fmt::format("{} [{}] ", question, otherwise) << std::flush;
            if (!std::getline(answers_, answer) || answer.empty()) return;
        } while (!take(answer));
    }

    const std::function<bool(std::string_view)>& is_given_;
    std::istream& answers_;
    std::ostream& questions_;
};

}  // namespace

void ask(RigDraft& draft, const std::function<bool(std::string_view option)>& is_given, std::istream& answers,
         std::ostream& questions) {
    Interview interview(is_given, answers, questions);
    interview.kind(draft.kind);
    interview.word("--name", "The rig's name?", draft.name);
    interview.range("--travel-mm", "Travel of the axis, LOW,HIGH in mm?", draft.travel_mm);
    interview.positive("--resolution-mm", "A count of its encoder, in mm?", draft.resolution_mm);
    interview.positive("--command-limit-V", "Largest command of its motor, in V?", draft.command_limit_V);
    draft.friction_V = friction_V_of(draft);
    interview.positive("--friction-V", "A command that surely moves it, and little more, in V?",
                       draft.friction_V);
    if (draft.has_micro()) {
        interview.range("--micro-travel-mm", "Travel of the micro stage, LOW,HIGH in mm?",
                        draft.micro_travel_mm);
        interview.positive("--heater-onset-V", "Command at which its wire begins to heat, in V?",
                           draft.heater_onset_V);
        interview.positive("--heater-limit-V", "Largest command that its wire bears, in V?",
                           draft.heater_limit_V);
    }
    if (draft.has_camera()) {
        interview.positive("--tag-side-mm", "Side of a tag's black border, in mm?", draft.tag_side_mm);
        interview.positive("--pitch-mm", "From tag to tag, in mm?", draft.pitch_mm);
    }
}

}  // namespace fidservo
