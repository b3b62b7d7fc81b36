// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the coefficients of a name's probability (gap/verdict/standing.h) to self-checks, and judges them on
// families of effects that were left out of the fit: calibrate SELF-CHECK.json... > gap/verdict/calibration.h
//
// A name counts by the share of its kind of case below, whatever the number of names in it, so that rigs with
// many causes do not outvote the others.
#include "gap/verdict/standing.h"
#include "src/selfcheck/tally/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace {

using namespace fidservo;
using Json = nlohmann::json;

constexpr std::size_t feature_count = gap::feature_names.size();

/// What diagnoses are expected to be about: a machine differs in many small ways more often than in one, now
/// and then in a way that nobody has listed, and with a fine encoder it is far off the floor whatever
/// explains it.
const std::map<std::string, double> share_of_kind{{"one", 0.08},        {"two", 0.08},   {"withheld", 0.08},
                                                  {"unlisted", 0.08},   {"three", 0.18}, {"messy", 0.18},
                                                  {"messy-none", 0.16}, {"rough", 0.16}};

struct Name {
    std::string kind, family;
    gap::Features features;
    bool is_true;
    bool is_replaced;  ///< by an equation
    double weight = 1.0;
};

gap::Support support_of(const Json& json, double gap_after) {
    return {.weight = json.at("weight"),
            .left_floors = json.at("left_floors"),
            .without_floors = json.at("without_floors"),
            .gap_after = gap_after,
            .gap_left = json.at("gap_left"),
            .names = json.at("names"),
            .halves_apart = json.at("halves_apart"),
            .is_at_bound = json.at("at_bound"),
            .leaves_something = json.at("leaves_something"),
            .leaves_dependence = json.at("leaves_dependence"),
            .is_contested = json.at("contested")};
}

/// The names that the diagnoses of a self-check gave, without those that share their probability with a rival
/// (gap/verdict/standing.h).
std::vector<Name> names_of(const Json& self_check) {
    std::vector<Name> names;
    for (const Json& one : self_check.at("cases"))
        for (const Json& found : one.at("found")) {
            const gap::Support support = support_of(found.at("support"), one.at("gap").at("after"));
            if (gap::has_a_rival(support)) continue;
            names.push_back({one.at("kind"), found.at("class"), gap::features_of(support), found.at("true"),
                             found.at("replaced")});
        }
    return names;
}

void weigh(std::vector<Name>& names) {
    std::map<std::string, double> count;
    for (const Name& name : names) count[name.kind] += 1.0;
    double sum = 0.0;
    for (Name& name : names) sum += name.weight = share_of_kind.at(name.kind) / count[name.kind];
    for (Name& name : names) name.weight *= static_cast<double>(names.size()) / sum;
}

struct Coefficients {
    double offset = 0.0;
    gap::Features of_feature{};
};

/// Penalised likelihood, c_k expected within 1 / sqrt(ridge) of 0: Newton's method over those coefficients
/// that are not held at 0, from which one that would become negative is taken.
Coefficients fitted(const std::vector<Name>& names) {
    constexpr double ridge = 1.0;
    constexpr int iterations = 50;
    constexpr auto size = static_cast<Eigen::Index>(feature_count) + 1;
    std::set<Eigen::Index> held;
    Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
    const auto row_of = [&](const Name& name) {
        Eigen::VectorXd row(size);
        row(0) = 1.0;
        for (std::size_t k = 0; k < feature_count; ++k)
            row(static_cast<Eigen::Index>(k) + 1) = name.features[k];
        return row;
    };
    while (true) {
        for (int iteration = 0; iteration < iterations; ++iteration) {
            Eigen::VectorXd gradient = -ridge * values;
            Eigen::MatrixXd curvature = ridge * Eigen::MatrixXd::Identity(size, size);
            gradient(0) = 0.0;
            curvature(0, 0) = 1e-6;
            for (const Name& name : names) {
                const Eigen::VectorXd row = row_of(name);
                const double p = 1.0 / (1.0 + std::exp(-row.dot(values)));
                gradient += name.weight * ((name.is_true ? 1.0 : 0.0) - p) * row;
                curvature += name.weight * std::max(p * (1.0 - p), 1e-6) * row * row.transpose();
            }
            for (const Eigen::Index k : held) {
                gradient(k) = 0.0;
                curvature.row(k).setZero();
                curvature.col(k).setZero();
                curvature(k, k) = 1.0;
            }
            Eigen::VectorXd step = curvature.ldlt().solve(gradient);
            constexpr double longest = 1.0;
            if (step.norm() > longest) step *= longest / step.norm();
            values += step;
        }
        Eigen::Index worst = 0;
        if (values.tail(size - 1).minCoeff(&worst) >= 0.0) break;
        held.insert(worst + 1);
        values(worst + 1) = 0.0;
    }
    Coefficients found{.offset = values(0)};
    for (std::size_t k = 0; k < feature_count; ++k)
        found.of_feature[k] = values(static_cast<Eigen::Index>(k) + 1);
    return found;
}

struct Judged {
    const Name* name;
    double probability;
};

/// Every name by coefficients that know neither its family nor any other of the same fold.
std::vector<Judged> judged_by_others(const std::vector<Name>& names) {
    constexpr std::size_t folds = 8;
    std::vector<Judged> judged;
    for (std::size_t fold = 0; fold < folds; ++fold) {
        const auto is_of_fold = [&](const Name& name) {
            return std::hash<std::string>{}(name.family) % folds == fold;
        };
        std::vector<Name> others;
        for (const Name& name : names)
            if (!is_of_fold(name)) others.push_back(name);
        const Coefficients coefficients = fitted(others);
        for (const Name& name : names)
            if (is_of_fold(name))
                judged.push_back({&name, gap::logistic_probability(name.features, coefficients.offset,
                                                                   coefficients.of_feature)});
    }
    return judged;
}

/// Expected calibration error of ten bins of equal weight, and Brier's score.
std::pair<double, double> errors_of(std::vector<Judged> judged) {
    constexpr double bins = 10.0;
    std::ranges::sort(judged, {}, &Judged::probability);
    double all = 0.0, brier = 0.0, error = 0.0, weight = 0.0, claimed = 0.0, came_true = 0.0;
    for (const Judged& one : judged) all += one.name->weight;
    for (std::size_t k = 0; k < judged.size(); ++k) {
        const double truth = judged[k].name->is_true ? 1.0 : 0.0, own = judged[k].name->weight;
        brier += own * std::pow(judged[k].probability - truth, 2) / all;
        weight += own;
        claimed += own * judged[k].probability;
        came_true += own * truth;
        if (weight < all / bins && k + 1 < judged.size()) continue;
        error += std::abs(claimed - came_true) / all;
        weight = claimed = came_true = 0.0;
    }
    return {error, brier};
}

void tell(const std::vector<Name>& names, const std::vector<Judged>& judged) {
    const auto [error, brier] = errors_of(judged);
    fmt::print(stderr, "{} names; families left out: calibration error {:.3f}, Brier {:.3f}\n", names.size(),
               error, brier);
    for (const auto& [kind, share] : share_of_kind) {
        std::vector<Judged> here;
        double came_true = 0.0, confident_wrong = 0.0;
        for (const Judged& one : judged) {
            if (one.name->kind != kind) continue;
            here.push_back(one);
            came_true += one.name->is_true ? 1.0 : 0.0;
            confident_wrong += !one.name->is_true && one.probability >= selfcheck::confident ? 1.0 : 0.0;
        }
        if (here.empty()) continue;
        fmt::print(
            stderr,
            "  {:<10} share {:.2f}: {:>4} names, {:.3f} true, {} wrong with {} or more, error {:.3f}\n", kind,
            share, here.size(), came_true / static_cast<double>(here.size()), confident_wrong,
            selfcheck::confident, errors_of(here).first);
    }
}

void calibrate(const std::vector<std::string>& files) {
    std::vector<Name> names;
    std::vector<std::string> sources;
    for (const std::string& file : files) {
        std::ifstream stream(file);
        const Json self_check = Json::parse(stream);
        const std::vector<Name> here = names_of(self_check);
        names.insert(names.end(), here.begin(), here.end());
        sources.push_back(fmt::format(
            "seed {}, {} cases of {}, commit {}", self_check.at("options").at("seed").get<std::uint64_t>(),
            self_check.at("cases").size(),
            fmt::join(self_check.at("options").at("kinds").get<std::vector<std::string>>(), ", "),
            self_check.at("commit").get<std::string>()));
    }
    weigh(names);  // all, so that the few that remain of a kind do not count for the others
    std::erase_if(names, std::mem_fn(&Name::is_replaced));
    tell(names, judged_by_others(names));
    const Coefficients all = fitted(names);
    fmt::print(R"(// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     {}
#include <array>

namespace fidservo::gap {{

inline constexpr double calibrated_offset = {:.3f};
inline constexpr std::array calibrated_coefficients{{
)",
               fmt::join(sources, "\n//     "), all.offset);
    for (std::size_t k = 0; k < feature_count; ++k)
        fmt::print("    {:.3f},  // {}\n", all.of_feature[k], gap::feature_names[k]);
    fmt::print("}};\n\n}}  // namespace fidservo::gap\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fputs("usage: calibrate SELF-CHECK.json... > gap/verdict/calibration.h\n", stderr);
        return 2;
    }
    try {
        calibrate({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "calibrate: %s\n", error.what());
        return 2;
    }
    return 0;
}
