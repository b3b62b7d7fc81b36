// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/result.h"

#include "core/input_error.h"
#include "src/files/table/clock_time.h"
#include "src/fleet/result_store.h"

#include <cmath>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {
namespace {

using ResultJson = nlohmann::json;

constexpr std::int64_t ns_per_s = 1'000'000'000;

/// A place in a result file: what messages name.
class ResultPlace {
  public:
    ResultPlace(const std::string& file, std::string path, const ResultJson& value)
        : file_(file), path_(std::move(path)), value_(value) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}: {}", file_, path_.empty() ? "the file" : path_, what));
    }
    bool has(const char* key) const {
        return value_.is_object() && value_.contains(key) && !value_[key].is_null();
    }
    ResultPlace at(const char* key) const {
        const std::string path = path_.empty() ? key : path_ + "." + key;
        if (!value_.is_object() || !value_.contains(key))
            throw InputError(fmt::format("{}: {}: is missing", file_, path));
        return {file_, path, value_[key]};
    }
    std::string text() const {
        if (!value_.is_string()) fail(fmt::format("is {}; allowed: text", value_.dump()));
        return value_.get<std::string>();
    }
    bool truth() const {
        if (!value_.is_boolean()) fail(fmt::format("is {}; allowed: true, false", value_.dump()));
        return value_.get<bool>();
    }
    double number() const {
        constexpr double most = 1e12;  // beyond anything that a rig has in any unit
        if (!value_.is_number() || !(std::abs(value_.get<double>()) <= most))
            fail(fmt::format("is {}; allowed: a number up to {:g}", value_.dump(), most));
        return value_.get<double>();
    }
    /// A number that a diagnosis may leave null.
    double number_or_nan() const { return value_.is_null() ? std::nan("") : number(); }
    template <class Visit>
    void each(const Visit& visit) const {
        if (!value_.is_array()) fail("is no list");
        for (std::size_t k = 0; k < value_.size(); ++k)
            visit(ResultPlace{file_, fmt::format("{}[{}]", path_, k), value_[k]});
    }
    const ResultJson& value() const { return value_; }

  private:
    const std::string& file_;
    std::string path_;
    const ResultJson& value_;
};

std::int64_t time_of(const ResultPlace& place) {
    const std::string text = place.text();
    const std::optional<ClockTime> time = clock_time_of(text);
    if (!time || !time->has_date)
        place.fail(fmt::format("is '{}'; allowed: a date and time like 2026-11-02T08:15:00Z", text));
    return time->ns / ns_per_s - (time->ns % ns_per_s < 0 ? 1 : 0);
}

double std_at(const ResultPlace& parameter) {
    const ResultPlace place = parameter.at("std");
    const double std = place.number_or_nan();
    if (std < 0.0) place.fail(fmt::format("is {:g}; allowed: 0 or more", std));
    return std;
}

NamedEffect effect_at(const ResultPlace& place) {
    NamedEffect effect;
    effect.effect = place.at("effect").text();
    effect.block = place.at("block").text();
    effect.probability = place.at("probability").number_or_nan();
    effect.gap_removed = place.at("gap_removed").number_or_nan();
    if (place.has("support") && place.at("support").has("gap_alone"))
        effect.gap_alone = place.at("support").at("gap_alone").number();
    place.at("parameters").each([&](const ResultPlace& one) {
        effect.parameters.push_back(
            {one.at("name").text(), one.at("unit").text(), one.at("value").number_or_nan(), std_at(one)});
    });
    place.at("indistinguishable_from").each([&](const ResultPlace& one) {
        effect.indistinguishable_from.push_back(one.text());
    });
    return effect;
}

void read_diagnosis(const ResultPlace& place, FleetResult& result) {
    const std::string format = place.at("format").text();
    if (format != "fidservo-diagnosis/1")
        place.at("format").fail(fmt::format("is '{}'; allowed: fidservo-diagnosis/1", format));
    result.verdict = place.at("verdict").text();
    result.ended = place.has("ended") ? place.at("ended").text() : "finished";
    result.gap_before = place.at("gap").at("before").number();
    result.gap_after = place.at("gap").at("after").number();
    if (place.has("unexplained")) result.unexplained = place.at("unexplained").at("block").text();
    place.at("signals").each([&](const ResultPlace& one) {
        result.signals.push_back({one.at("signal").text(), one.at("unit").text(),
                                  one.at("before").number_or_nan(), one.at("after").number_or_nan(),
                                  one.at("floor").number_or_nan()});
    });
    place.at("where").each([&](const ResultPlace& one) {
        result.blocks.push_back({one.at("block").text(), one.at("probability").number()});
    });
    place.at("effects").each([&](const ResultPlace& one) { result.effects.push_back(effect_at(one)); });
    place.at("candidates").each([&](const ResultPlace& one) {
        result.tried.push_back({one.at("effect").text(), one.at("probability").number_or_nan(),
                                one.at("gap_removed").number_or_nan(),
                                !one.has("would_show") || one.at("would_show").truth()});
    });
}

void read_task(const ResultPlace& task, FleetResult& result) {
    result.campaign = task.at("campaign").text();
    result.campaign_content = task.at("content").text();
    if (task.has("unit")) result.unit = task.at("unit").text();
    if (task.has("recorded_at")) result.recorded_at_s = time_of(task.at("recorded_at"));
    if (!task.has("labels")) return;
    const ResultPlace labels = task.at("labels");
    if (!labels.value().is_object()) labels.fail("is no map of names and values");
    for (const auto& [key, value] : labels.value().items())
        result.labels[key] = value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

FleetResult result_of(const std::string& file, std::string_view text) {
    const ResultJson json = ResultJson::parse(text, nullptr, false);
    if (json.is_discarded()) throw InputError(file + ": is no whole JSON file");
    const ResultPlace root(file, "", json);
    const std::string format =
        root.has("format") && json["format"].is_string() ? root.at("format").text() : "";
    if (format != result_format)
        throw InputError(fmt::format("{}: format: is '{}'; allowed: {}", file, format, result_format));
    FleetResult result;
    result.file = file;
    const std::string kind = root.at("task").at("kind").text();
    if (kind != "diagnose")
        throw InputError(fmt::format("{}: task.kind: is '{}'; a report is made of: diagnose", file, kind));
    read_task(root.at("task"), result);
    result.rig_name = root.at("rig").at("name").text();
    result.rig_content = root.at("rig").at("content").text();
    result.program = root.at("program").text();
    result.effort = root.at("effort").number();
    const std::string status = root.at("status").text();
    if (status != "done" && status != "failed")
        throw InputError(fmt::format("{}: status: is '{}'; allowed: done, failed", file, status));
    result.done = status == "done";
    if (result.done)
        read_diagnosis(root.at("diagnosis"), result);
    else
        result.reason = root.at("reason").text();
    return result;
}

std::string date_of(std::int64_t time_s) {
    const std::time_t time = time_s;
    std::tm parts{};
    ::gmtime_r(&time, &parts);
    return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

}  // namespace fidservo::fleet
