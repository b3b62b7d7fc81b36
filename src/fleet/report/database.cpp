// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/database.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "src/files/disk/sha256.h"
#include "src/fleet/report/schema.h"
#include "src/fleet/report/sqlite.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

constexpr const char* tables_of_file[] = {"labels",     "signals", "blocks", "effects",
                                          "parameters", "ties",    "tried",  "results"};

/// Opens the database with the tables of this version in it, empty if they were of another one.
Database opened(const std::filesystem::path& file) {
    Database database(file);
    const std::int64_t id = database.number("PRAGMA application_id");
    const std::int64_t tables = database.number("SELECT count(*) FROM sqlite_schema");
    if (id != fleet_application_id && tables > 0)
        throw InputError(
            fmt::format("{}: is a database of another program; give it another name", file.string()));
    database.run("PRAGMA synchronous = NORMAL");
    database.run("BEGIN IMMEDIATE");
    if (database.number("PRAGMA application_id") == fleet_application_id &&
        database.number("PRAGMA user_version") == fleet_schema_version)
        return database;
    database.run("DROP VIEW IF EXISTS series");
    for (const char* table : tables_of_file)
        database.run(fmt::format("DROP TABLE IF EXISTS {}", table).c_str());
    database.run(fleet_schema);
    database.run(fmt::format("PRAGMA application_id = {}", fleet_application_id).c_str());
    database.run(fmt::format("PRAGMA user_version = {}", fleet_schema_version).c_str());
    return database;
}

/// Writes results into all tables.
class ResultWriter {
  public:
    explicit ResultWriter(sqlite3* database)
        : results_(database, "INSERT INTO results VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
          labels_(database, "INSERT INTO labels VALUES (?,?,?)"),
          signals_(database, "INSERT OR IGNORE INTO signals VALUES (?,?,?,?,?,?)"),
          blocks_(database, "INSERT OR IGNORE INTO blocks VALUES (?,?,?)"),
          effects_(database, "INSERT INTO effects VALUES (?,?,?,?,?,?,?)"),
          parameters_(database, "INSERT INTO parameters VALUES (?,?,?,?,?,?,?,?)"),
          ties_(database, "INSERT OR IGNORE INTO ties VALUES (?,?,?)"),
          tried_(database, "INSERT OR IGNORE INTO tried VALUES (?,?,?,?,?)") {
        for (const char* table : tables_of_file)
            removals_.emplace_back(database, fmt::format("DELETE FROM {} WHERE file = ?", table));
    }

    void remove(const std::string& file) {
        for (Statement& removal : removals_) removal.run(file);
    }

    void add(const FleetResult& result, const std::string& sha256) {
        const auto if_done = [&](const std::string& text) {
            return result.done ? std::optional(text) : std::nullopt;
        };
        const double nan = std::numeric_limits<double>::quiet_NaN();
        results_.run(result.file, sha256, result.campaign, result.campaign_content, result.unit,
                     result.recorded_at_s, result.rig_name, result.rig_content, result.program, result.effort,
                     std::string(result.done ? "done" : "failed"),
                     result.done ? std::nullopt : std::optional(result.reason), if_done(result.verdict),
                     if_done(result.ended), result.done ? result.gap_before : nan,
                     result.done ? result.gap_after : nan,
                     result.unexplained.empty() ? std::nullopt : std::optional(result.unexplained));
        for (const auto& [label, value] : result.labels) labels_.run(result.file, label, value);
        for (const SignalSize& signal : result.signals)
            signals_.run(result.file, signal.signal, signal.unit, signal.before, signal.after, signal.floor);
        for (const AccusedBlock& block : result.blocks)
            blocks_.run(result.file, block.block, block.probability);
        std::int64_t place = 0;
        for (const NamedEffect& effect : result.effects) add(result.file, place++, effect);
        for (const TriedAlone& tried : result.tried)
            tried_.run(result.file, tried.effect, tried.probability, tried.gap_removed,
                       static_cast<std::int64_t>(tried.would_show ? 1 : 0));
    }

  private:
    void add(const std::string& file, std::int64_t place, const NamedEffect& effect) {
        effects_.run(file, place, effect.effect, effect.block, effect.probability, effect.gap_removed,
                     effect.gap_alone);
        std::int64_t number = 0;
        for (const NamedParameter& parameter : effect.parameters)
            parameters_.run(file, place, number++, effect.effect, parameter.name, parameter.unit,
                            parameter.value, parameter.std);
        for (const std::string& other : effect.indistinguishable_from) ties_.run(file, place, other);
    }

    Statement results_, labels_, signals_, blocks_, effects_, parameters_, ties_, tried_;
    std::vector<Statement> removals_;
};

std::string bytes_of(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InputError(fmt::format("{}: is no file", file.filename().string()));
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) throw InputError(fmt::format("{}: cannot be read", file.filename().string()));
    std::string bytes(static_cast<std::size_t>(std::max<std::streamoff>(0, stream.tellg())), '\0');
    stream.seekg(0);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw InputError(fmt::format("{}: cannot be read", file.filename().string()));
    return bytes;
}

std::vector<std::filesystem::path> result_files(const std::filesystem::path& fleet) {
    const std::filesystem::path folder = fleet / "results";
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->path().extension() == ".json" && !entry->path().filename().string().starts_with('.'))
            files.push_back(entry->path());
    if (error)
        throw InputError(fmt::format("{}: {}; allowed: the folder that fleet diagnose --out made",
                                     folder.string(), error.message()));
    std::ranges::sort(files);
    return files;
}

void bring_up_to_date(const Database& database, const std::vector<std::filesystem::path>& files,
                      Collected& collected) {
    std::map<std::string, std::string> known;
    Statement kept(database.get(), "SELECT file, sha256 FROM results");
    while (kept.step()) known.emplace(kept.text(0), kept.text(1));
    ResultWriter writer(database.get());
    for (const std::filesystem::path& path : files) {
        const std::string file = path.filename().string();
        try {
            const std::string bytes = bytes_of(path);
            const std::string hash = sha256(bytes);
            const auto old = known.find(file);
            const bool is_new = old == known.end();
            if (!is_new && old->second == hash) {
                known.erase(old);
                continue;
            }
            const FleetResult result = result_of(file, bytes);
            if (!is_new) writer.remove(file);
            writer.add(result, hash);
            collected.added += 1;
            if (!is_new) known.erase(old);
        } catch (const InputError& error) {
            collected.damaged.emplace_back(error.what());
        }
    }
    for (const auto& [file, sha256] : known) {
        writer.remove(file);
        collected.removed += 1;
    }
}

/// The results, without what belongs to them in other tables.
std::vector<FleetResult> bare_results(const Database& database) {
    std::vector<FleetResult> results;
    Statement rows(
        database.get(),
        "SELECT file, campaign, campaign_sha256, unit, recorded_at_s, rig, rig_sha256, program, effort, "
        "status, reason, verdict, ended, gap_before, gap_after, unexplained_block FROM results ORDER BY "
        "file");
    while (rows.step()) {
        FleetResult& result = results.emplace_back();
        result.file = rows.text(0);
        result.campaign = rows.text(1);
        result.campaign_content = rows.text(2);
        result.unit = rows.optional_text(3);
        result.recorded_at_s = rows.optional_integer(4);
        result.rig_name = rows.text(5);
        result.rig_content = rows.text(6);
        result.program = rows.text(7);
        result.effort = rows.number(8);
        result.done = rows.text(9) == "done";
        result.reason = rows.text(10);
        result.verdict = rows.text(11);
        result.ended = rows.text(12);
        result.gap_before = rows.number(13);
        result.gap_after = rows.number(14);
        result.unexplained = rows.text(15);
    }
    return results;
}

/// Calls a visitor with each row of a table, whose first column is the file, and the file's result.
template <class Visit>
void join(const Database& database, const char* sql, std::vector<FleetResult>& results, const Visit& visit) {
    Statement rows(database.get(), sql);
    auto result = results.begin();
    while (rows.step()) {
        const std::string file = rows.text(0);
        while (result != results.end() && result->file < file) ++result;
        if (result == results.end()) return;
        visit(*result, rows);
    }
}

std::vector<FleetResult> all_results(const Database& database) {
    std::vector<FleetResult> results = bare_results(database);
    join(database, "SELECT file, label, value FROM labels ORDER BY file", results,
         [](FleetResult& result, Statement& row) { result.labels[row.text(1)] = row.text(2); });
    join(
        database, "SELECT file, signal, unit, gap_before, gap_after, floor FROM signals ORDER BY file",
        results, [](FleetResult& result, Statement& row) {
            result.signals.push_back({row.text(1), row.text(2), row.number(3), row.number(4), row.number(5)});
        });
    join(database, "SELECT file, block, probability FROM blocks ORDER BY file, probability DESC", results,
         [](FleetResult& result, Statement& row) {
             result.blocks.push_back({row.text(1), row.number(2)});
         });
    join(database,
         "SELECT file, effect, block, probability, gap_removed, gap_alone FROM effects ORDER BY file, place",
         results, [](FleetResult& result, Statement& row) {
             result.effects.push_back(
                 {row.text(1), row.text(2), row.number(3), row.number(4), row.number(5), {}, {}});
         });
    join(database,
         "SELECT file, place, parameter, unit, value, std FROM parameters ORDER BY file, place, number",
         results, [](FleetResult& result, Statement& row) {
             result.effects.at(static_cast<std::size_t>(row.integer(1)))
                 .parameters.push_back({row.text(2), row.text(3), row.number(4), row.number(5)});
         });
    join(database, "SELECT file, place, effect FROM ties ORDER BY file, place", results,
         [](FleetResult& result, Statement& row) {
             result.effects.at(static_cast<std::size_t>(row.integer(1)))
                 .indistinguishable_from.push_back(row.text(2));
         });
    join(database, "SELECT file, effect, probability, gap_removed, would_show FROM tried ORDER BY file",
         results, [](FleetResult& result, Statement& row) {
             result.tried.push_back({row.text(1), row.number(2), row.number(3), row.integer(4) != 0});
         });
    return results;
}

}  // namespace

Collected collect_results(const std::filesystem::path& fleet) {
    const std::vector<std::filesystem::path> files = result_files(fleet);
    const Database database = opened(fleet / "fleet.sqlite");
    Collected collected;
    bring_up_to_date(database, files, collected);
    database.run("COMMIT");
    collected.results = all_results(database);
    return collected;
}

}  // namespace fidservo::fleet
