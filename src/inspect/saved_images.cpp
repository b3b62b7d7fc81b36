// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/saved_images.h"

#include "core/camera/camera_parameters.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "src/images/grey_range.h"
#include "src/images/image_list.h"
#include "vision/images/image_file.h"

#include <string_view>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

namespace fs = std::filesystem;

std::string stem_of(int tag_id, bool again, const std::string& view) {
    return fs::path(image_name(tag_id, again, view)).stem().string();
}

}  // namespace

std::optional<fs::path> images_folder(const std::string& camera) {
    constexpr std::string_view prefix = "images:";
    if (!camera.starts_with(prefix)) return std::nullopt;
    return fs::path(camera.substr(prefix.size()));
}

SavedImages::SavedImages(const fs::path& folder, const Recipe& recipe) : folder_(folder) {
    std::error_code error;
    if (fs::is_directory(folder / "images", error)) folder_ = folder / "images";
    if (!fs::is_directory(folder_, error))
        throw InputError(fmt::format("--camera images:{}: no such folder", folder.string()));
    std::vector<DeepImage> deep;
    for (const fs::path& file : look_into(folder_).images) {
        files_[file.stem().string()] = file;
        const auto pages = vision::list_pages(file);
        if (pages && pages->front().is_deep) deep.push_back({file, pages->front().page});
    }
    bits_ = levels_of(deep).bits();
    for (const Site& site : recipe.sites)
        for (const View& view : site.views)
            if (find(site.tag_id, view.name) != nullptr) return;
    const Site& first = recipe.sites.front();
    throw InputError(
        fmt::format("--camera images:{}: no image of this recipe's sites and views; the first "
                    "would be called {}.png",
                    folder.string(), stem_of(first.tag_id, false, first.views.front().name)));
}

const fs::path* SavedImages::find(int tag_id, const std::string& view) const {
    for (const bool again : {true, false})
        if (const auto file = files_.find(stem_of(tag_id, again, view)); file != files_.end())
            return &file->second;
    return nullptr;
}

Result<vision::Frame> SavedImages::image_of(const Site& site, const View& view,
                                            const CameraParameters& camera) const {
    const fs::path* file = find(site.tag_id, view.name);
    if (file == nullptr)
        return failure(
            Reason::no_image,
            fmt::format("no image {} in {}", stem_of(site.tag_id, false, view.name), folder_.string()));
    const auto stored = vision::read_stored(*file);
    if (!stored) throw InputError(stored.error().text);
    const CameraGeometry& geometry = camera.geometry;
    if (stored->grey.cols != geometry.width_px || stored->grey.rows != geometry.height_px)
        throw InputError(fmt::format("{}: {} x {} px; the rig's camera has {} x {} px", file->string(),
                                     stored->grey.cols, stored->grey.rows, geometry.width_px,
                                     geometry.height_px));
    vision::Frame frame;
    frame.image = vision::to_8_bits(*stored, bits_);
    frame.source = file->filename().string();
    return frame;
}

namespace {

Result<Snapshot> saved_snapshot(const Measuring& by, const SavedImages& images, const Site& site,
                                const View& view) {
    const auto image = images.image_of(site, view, by.camera);
    if (!image) return tl::make_unexpected(image.error());
    return read_snapshot(*image, by.camera, by.recipe.nominal, site.tag_id, by.detector);
}

}  // namespace

Visit measure_saved(const Measuring& measuring, const SavedImages& images, const Site& site) {
    Visit visit{};
    visit.site = site.tag_id;
    visit.end = Visit::End::measured;
    Snapshots snapshots;
    std::map<std::string, std::string> trouble;
    for (const View& view : site.views) {
        auto snapshot = saved_snapshot(measuring, images, site, view);
        if (snapshot) {
            snapshots.emplace_back(std::move(*snapshot));
            continue;
        }
        snapshots.emplace_back();
        const Failure& why = snapshot.error();
        visit.failures.push_back({view.name, std::string(name_of(why.reason)), why.text});
        trouble[view.name] = fmt::format("{}: {}", name_of(why.reason), why.text);
        visit.end = Visit::End::skipped;
    }
    measure_site(
        measuring, site, snapshots,
        [&](const View& view) {
            const auto why = trouble.find(view.name);
            return why == trouble.end() ? std::string() : why->second;
        },
        visit);
    return visit;
}

}  // namespace fidservo::inspect
