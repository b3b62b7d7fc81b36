// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// `--camera images:DIR`: the images of an earlier run measured again, by today's recipe; nothing moves.
#include "core/result.h"
#include "src/inspect/measure/site_measurement.h"
#include "vision/camera.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace fidservo::inspect {

/// DIR of "images:DIR"; empty for another camera.
std::optional<std::filesystem::path> images_folder(const std::string& camera);

/// The images of an inspection, by site and view: "site-012-left.png", or "site-012-again-left.png" where the
/// second visit took it.
class SavedImages {
  public:
    /// @param folder  of images, or of a run that has them in its folder "images". Throws InputError if there
    /// is no such folder or if it holds no image of the recipe's sites and views.
    SavedImages(const std::filesystem::path& folder, const Recipe& recipe);

    /// Fails with no_image. Throws InputError for an image that cannot be read or that is not of the camera's
    /// size.
    Result<vision::Frame> image_of(const Site& site, const View& view, const CameraParameters& camera) const;

  private:
    const std::filesystem::path* find(int tag_id, const std::string& view) const;

    std::filesystem::path folder_;
    std::map<std::string, std::filesystem::path> files_;  ///< by name without the extension
    int bits_ = 16;                                       ///< of samples of more than 8 bits, in all of them
};

/// One site, its images measured; those that are missing or show no fiducial are `not_measured`.
Visit measure_saved(const Measuring& measuring, const SavedImages& images, const Site& site);

}  // namespace fidservo::inspect
