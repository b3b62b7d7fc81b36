// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/site_measurement.h"

#include "src/files/disk/durable_file.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fidservo::inspect {
namespace {

void save_image(const std::filesystem::path& file, const cv::Mat& grey) {
    set_aside(file);
    constexpr int small_and_fast_compression = 3;
    const std::vector<unsigned char> png = vision::encode_png(grey, small_and_fast_compression);
    replace_file(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace

void measure_site(const Measuring& measuring, const Site& site, const Snapshots& snapshots,
                  const Trouble& trouble, Visit& visit) {
    std::vector<Snapshot> taken;
    for (const auto& snapshot : snapshots)
        if (snapshot) taken.push_back(*snapshot);
    for (std::size_t k = 0; k < site.views.size(); ++k) {
        const View& view = site.views[k];
        const std::string why = trouble(view);
        if (!snapshots[k]) {
            std::ranges::move(rows_not_measured(site, view, why), std::back_inserter(visit.rows));
            continue;
        }
        const std::string image = image_name(site.tag_id, visit.again, view.name);
        save_image(measuring.output.root / image, snapshots[k]->image.grey);
        CheckedView checked = check_view(
            {site, view, measuring.recipe.nominal, *snapshots[k], taken, measuring.draw_nominal, image});
        if (!why.empty())
            for (ResultRow& row : checked.rows) row.reason += (row.reason.empty() ? "" : "; ") + why;
        std::ranges::move(checked.rows, std::back_inserter(visit.rows));
        visit.views.push_back({view.name, image, snapshots[k]->image.axis_mm.x(),
                               snapshots[k]->image.axis_mm.y(), std::move(checked.overlays)});
    }
}

}  // namespace fidservo::inspect
