// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/targets.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"
#include "src/calibrate/camera_target.h"
#include "src/files/recording/frame_index.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/camera_info.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/fod_file.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/files/text/yaml_reader.h"
#include "src/identify/text_table.h"
#include "src/import/assemble.h"
#include "src/import/draft_map.h"
#include "src/import/guarded.h"
#include "src/import/import_map.h"
#include "src/import/import_module.h"
#include "src/import/recording_folder.h"
#include "src/import/table_log.h"
#include "src/inspect/journal.h"
#include "src/inspect/recipe/recipe.h"
#include "src/simulation/experiment_file.h"
#include "tests/inspect/small_recipe.h"
#include "vision/images/image_file.h"
#include "vision/images/media.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace fidservo::fuzz {

namespace {

namespace fs = std::filesystem;

/// A folder of this process, gone with it.
class Folder {
  public:
    Folder() : path_(fs::temp_directory_path() / ("fidservo-fuzz-" + std::to_string(::getpid()))) {
        fs::create_directories(path_ / "recording/stage0");
        fs::create_directories(path_ / "recording/cam0");
        fs::create_directories(path_ / "index/data");
        fs::copy_file(FIDSERVO_FUZZ_CORPUS "/fod.csv", path_ / "fod.csv",
                      fs::copy_options::overwrite_existing);
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    fs::path write(const fs::path& name, std::string_view bytes) const {
        std::ofstream stream(path_ / name, std::ios::binary | std::ios::trunc);
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path_ / name;
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

const Folder& folder() {
    static const Folder only;
    return only;
}

void answered(const auto& reader) {
    try {
        reader();
    } catch (const InputError&) {
    }
}

}  // namespace

void read_rig(std::string_view bytes) {
    const fs::path file = folder().write("rig.yaml", bytes);
    answered([&] { (void)load_rig(file); });
}

void read_recipe(std::string_view bytes) {
    static const Rig rig = inspect::small_rig();
    answered([&] { (void)inspect::parse_recipe(std::string(bytes), folder().path() / "recipe.yaml", rig); });
}

void read_experiment(std::string_view bytes) {
    static const Rig rig = load_rig(reference_rig_file());
    answered([&] { (void)parse_experiment(std::string(bytes), folder().path() / "experiment.yaml", rig); });
}

void read_effects(std::string_view bytes) {
    static const Rig rig = load_rig(reference_rig_file());
    answered([&] {
        const YamlValue root = YamlValue::parse(std::string(bytes), folder().path() / "effects.yaml");
        for (const plant::Effect* effect : read_effects_file(root)) {
            const plant::EffectSetting setting = plant::typical_setting(*effect);
            const plant::StagePlant plant = plant::make_stage_plant(rig, {&setting, 1});
            plant::StageState state = plant::start(plant, 100.0, 1);
            for (const double command_V : {0.0, 4.0, -4.0}) {
                (void)plant::sample(plant, state);
                plant::advance(plant, state, command_V, 1.6);
            }
        }
    });
}

void read_plate(std::string_view bytes) {
    const fs::path file = folder().write("plate.yaml", bytes);
    answered([&] { (void)load_plate(file); });
}

void read_recording(std::string_view bytes) {
    constexpr std::string_view cut = "%%%\n";
    for (const char* name : {"recording.yaml", "stage0/data.csv", "cam0/data.csv", "cam0/detections.csv"}) {
        const std::size_t end = bytes.find(cut);
        folder().write(fs::path("recording") / name, bytes.substr(0, end));
        bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + cut.size());
    }
    answered([] { (void)fidservo::read_recording(folder().path() / "recording"); });
}

void read_camera_info(std::string_view bytes) {
    const fs::path file = folder().write("camera.yaml", bytes);
    answered([&] { (void)load_camera_info(file); });
}

void read_camera_target(std::string_view bytes) {
    const fs::path file = folder().write("target.yaml", bytes);
    answered([&] { (void)load_kalibr_target(file); });
}

void read_image(std::string_view bytes) {
    const fs::path file = folder().write("image.png", bytes);
    (void)vision::read_grey(file);
}

void read_stack(std::string_view bytes) {
    constexpr std::size_t most_pages_tried = 20;
    const fs::path file = folder().write("stack.tif", bytes);
    const auto pages = vision::list_pages(file);
    if (!pages) return;
    for (std::size_t k = 0; k < std::min(most_pages_tried, pages->size()); ++k)
        (void)vision::read_stored(file, (*pages)[k].page);
}

void read_video(std::string_view bytes) {
    constexpr int most_frames_tried = 50;
    const auto video = vision::open_video(folder().write("video", bytes));
    if (!video) return;
    for (int k = 0; k < most_frames_tried; ++k)
        if (!(*video)->next()) return;
}

void read_table(std::string_view bytes) {
    const fs::path file = folder().write("table.csv", bytes);
    answered([&] { (void)read_text_table(file, {{"input", "1", ""}, {"output", "y", ""}}); });
    answered([&] {
        (void)read_text_table(file, {{"input", "2", ""}, {"output", "3", ""}, {"time", "1", ""}});
    });
    answered([&] {
        (void)read_text_table(file, {{"input", "1", "mm"}, {"output", "2", ""}},
                              {.header_lines = 1, .decimal = DecimalSign::comma, .separator = ';'});
    });
    answered([&] { (void)load_fod(file); });
}

void read_frame_index(std::string_view bytes) {
    const fs::path file = folder().write("index/data.csv", bytes);
    answered([&] { (void)fidservo::read_frame_index(file); });
}

void read_journal(std::string_view bytes) {
    const fs::path file = folder().write("journal.jsonl", bytes);
    answered([&] { (void)inspect::killed_before_it_began(file); });
    answered([&] { (void)inspect::Journal::resume(file, inspect::RunIdentity{}); });
}

namespace {

/// libhdf5 runs for ever on some damaged files, which its process is there for.
constexpr imports::ReadingLimits short_reading{.processor_s = 2};

}  // namespace

void read_mat(std::string_view bytes) {
    const fs::path file = folder().write("log.mat", bytes);
    answered(
        [&] { (void)imports::read_guarded(file, imports::import_module(file).read_mat, short_reading); });
}

void read_hdf5(std::string_view bytes) {
    const fs::path file = folder().write("log.h5", bytes);
    answered(
        [&] { (void)imports::read_guarded(file, imports::import_module(file).read_hdf5, short_reading); });
}

void read_bag(std::string_view bytes) {
    const fs::path file = folder().write("bag.db3", bytes);
    const imports::LogOrFault log = imports::import_module(file).read_rosbag2({file}, [] { return false; });
    if (!log) return;
    for (const imports::LoggedCamera& camera : log->cameras)
        for (std::size_t k = 0; k < std::min<std::size_t>(3, camera.times_ns.size()); ++k)
            (void)camera.frame(k);
}

void read_import_map(std::string_view bytes) {
    imports::Log log{.file = "log.csv"};
    for (const char* name : {"t", "x", "u", "id"}) log.signals.push_back({.name = name});
    for (int k = 0; k < 40; ++k)
        for (imports::LoggedSignal& signal : log.signals)
            signal.values.push_back(signal.name == "t" ? 0.01 * k : k % 7);
    log.signals[1].unit = "mm";
    answered([&] {
        const imports::Assembled made = imports::assemble(
            {log}, imports::parse_import_map(std::string(bytes), folder().path() / "map.yaml"));
        (void)imports::stage_text(made.recording, made.decimals);
        (void)imports::detections_text(made.recording.detections);
    });
}

void read_table_log(std::string_view bytes) {
    const fs::path file = folder().write("log.csv", bytes);
    answered([&] { (void)imports::draft_map({imports::read_table_log(file, {.are_offered = false})}); });
}

}  // namespace fidservo::fuzz
