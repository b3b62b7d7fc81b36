// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One task's result for the report: a campaign of a unit and its diagnosis, from a file of FLEET/results
// (format fidservo-fleet-result/1).
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::fleet {

/// A number of a named effect, in its unit.
struct NamedParameter {
    std::string name, unit;  ///< as in the catalogue of effects
    double value, std;       ///< as fitted; one standard error
};

/// An effect that a diagnosis names.
struct NamedEffect {
    std::string effect, block;  ///< as in the catalogue of effects
    double probability = 0.0;   ///< probability of its being present
    double gap_removed = 0.0;   ///< fraction of the gap that is removed with it and those before it
    /// The gap that it alone would cause, in floors; NaN where the file does not state it.
    double gap_alone = std::numeric_limits<double>::quiet_NaN();
    std::vector<NamedParameter> parameters;  ///< in the diagnosis's order
    /// Effects that the campaign cannot distinguish from it.
    std::vector<std::string> indistinguishable_from;
};

/// An effect that was tried alone.
struct TriedAlone {
    std::string effect;               ///< as in the catalogue of effects
    double probability, gap_removed;  ///< as in the diagnosis
    bool would_show = true;           ///< whether the campaign would show it at its typical size
};

/// A signal's gap, r.m.s., in its unit.
struct SignalSize {
    std::string signal, unit;     ///< as in the diagnosis
    double before, after, floor;  ///< without effects, with those named, and by noise alone
};

/// A block with the probability that the rig file is wrong in it.
struct AccusedBlock {
    std::string block;   ///< macro.friction and the like
    double probability;  ///< 0 to 1
};

/// One result.
struct FleetResult {
    std::string file;                           ///< its name in FLEET/results
    std::string campaign, campaign_content;     ///< path as given; SHA-256 of its recordings
    std::optional<std::string> unit;            ///< the rig; empty where its recordings do not state it
    std::optional<std::int64_t> recorded_at_s;  ///< since 1970-01-01 UTC
    std::map<std::string, std::string> labels;  ///< of its recordings
    std::string rig_name, rig_content;          ///< of the rig file
    std::string program;                        ///< version
    double effort = 0.0;                        ///< computing effort spent
    bool done = false;                          ///< false: failed, for `reason`
    std::string reason;                         ///< why it failed
    std::string verdict, ended;                 ///< as in the diagnosis
    double gap_before = 1.0, gap_after = 1.0;   ///< in floors
    std::string unexplained;                    ///< block of what no effect explains; empty: none
    std::vector<SignalSize> signals;
    std::vector<AccusedBlock> blocks;
    std::vector<NamedEffect> effects;
    std::vector<TriedAlone> tried;
};

/// Reads a result.
/// @param file  its name, for messages
/// Throws InputError: one line with the file, the key and what is allowed.
FleetResult result_of(const std::string& file, std::string_view text);

/// "2026-11-02" of a time in seconds since 1970-01-01 UTC.
std::string date_of(std::int64_t time_s);

}  // namespace fidservo::fleet
