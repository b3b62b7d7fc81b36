// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/stretch_tables.h"

#include "core/input_error.h"
#include "src/fleet/stretch_result.h"
#include "src/images/image_tally.h"
#include "src/replay/replay_tables.h"
#include "vision/displacement.h"

#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <stdlib.h>

namespace fidservo::fleet {
namespace {

namespace fs = std::filesystem;

/// A folder for tables in the making, removed at the end.
class DraftFolder {
  public:
    explicit DraftFolder(const fs::path& in) {
        std::string name = (in / ".tables-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw RunFault(fmt::format("{}: no folder can be made in it", in.string()));
        path_ = name;
    }
    ~DraftFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    DraftFolder(const DraftFolder&) = delete;
    DraftFolder& operator=(const DraftFolder&) = delete;

    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

nlohmann::json read_result(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    nlohmann::json result = nlohmann::json::parse(stream, nullptr, false);
    if (!result.is_object()) throw RunFault(fmt::format("{}: cannot be read", file.string()));
    return result;
}

class Collection {
  public:
    Collection(const fs::path& draft, const ImageFrames& frames, double tag_side_mm)
        : frames_(frames),
          series_(frames.series()),
          tag_side_mm_(tag_side_mm),
          tables_(draft, frames.is_one_timed_series()),
          tally_(frames.missing()) {}

    void add(const Stretch& stretch, const nlohmann::json& result) {
        std::size_t series = stretch.series, number = stretch.first;
        for (const nlohmann::json& json : result.at("images")) {
            while (!series_[series].is_video && number == series_[series].frames) {
                ++series;
                number = 0;
            }
            add(frame_found(json), series, number++);
        }
    }

    void close() { tables_.close(); }
    const ImageTally& tally() const { return tally_; }
    std::size_t tags() const { return tags_; }

  private:
    void add(FrameFound found, std::size_t series, std::size_t number) {
        found.frame.name = frames_.frame_name(series, number);
        tally_.add(found.frame);
        if (!found.frame.damage.empty()) return;
        auto& tracker = trackers_.try_emplace(series, tag_side_mm_).first->second;
        tables_.add(found.frame, found.detections, tracker.add(found.places));
        tags_ += found.detections.size();
    }

    const ImageFrames& frames_;
    std::vector<ImageFrames::Series> series_;
    double tag_side_mm_;
    ReplayTables tables_;
    ImageTally tally_;
    std::map<std::size_t, vision::DisplacementTracker> trackers_;  ///< by series
    std::size_t tags_ = 0;
};

}  // namespace

void write_replay_tables(const fs::path& fleet, const fs::path& folder, const ImageFrames& frames,
                         const std::vector<Stretch>& stretches,
                         const std::map<std::size_t, std::string>& results, double tag_side_mm) {
    const DraftFolder draft(fleet);
    Collection collection(draft.path(), frames, tag_side_mm);
    for (const auto& [task, file] : results) {
        try {
            collection.add(stretches[task], read_result(folder / file));
        } catch (const nlohmann::json::exception& error) {
            throw RunFault(fmt::format("{}: {}", (folder / file).string(), error.what()));
        }
    }
    collection.close();
    for (const char* table : {"detections.csv", "displacements.csv"}) {
        std::error_code error;
        fs::rename(draft.path() / table, fleet / table, error);
        if (error)
            throw RunFault(
                fmt::format("{}: cannot be written: {}", (fleet / table).string(), error.message()));
    }
    for (const std::string& note : collection.tally().notes()) spdlog::info("{}", note);
    fmt::print("{} tags in {}: {}, {}\n", collection.tags(), collection.tally().text(),
               (fleet / "detections.csv").string(), (fleet / "displacements.csv").string());
}

}  // namespace fidservo::fleet
