// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Lists the frames of the user's image inputs, without decoding any.
#include "src/images/grey_range.h"
#include "src/images/image_frame.h"
#include "src/images/image_names.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

/// Frames that belong together.
struct ImageSeries {
    std::string name{};                  ///< file or folder
    std::vector<ImageFrame> frames{};    ///< without missing ones
    std::vector<DeepImage> deep{};       ///< those with samples of possibly more than 8 bits
    std::vector<std::string> missing{};  ///< names of frames that an index lists and that do not exist
    std::filesystem::path video{};       ///< the video's file, if it is one
};

struct ImageList {
    std::vector<ImageSeries> series;
    std::vector<std::string> notes;  ///< one line each: what was skipped, where times come from
};

/// Adds the frames of an input:
///   a folder with cam0/data.csv or mav0/cam0/data.csv (EuRoC), or such a cam0 itself: the index's frames,
///   with their times;
///   a folder with rgb.txt and the folder rgb (TUM): the list's frames, with their times;
///   a folder of such recordings of EuRoC's: each of them;
///   a folder of images: those, in natural order of their names, TIFFs page by page; what else is in it is
///   passed over and noted;
///   a folder without images that holds one folder camN of images (kalibr's): that;
///   a video, by its ending; any other file: an image, or a stack of them.
/// Images are told by their ending, others by what they begin with. Names of images may be times (NameTimes).
/// Throws InputError: there is no such input, or no image in it, or one of several cameras would have to be
/// guessed, or a name is not a time though `name_times` says so.
void list_images(const std::filesystem::path& input, NameTimes name_times, ImageList& list);

/// The images of a folder, in natural order, and the names of everything else in it.
struct FolderOfImages {
    std::vector<std::filesystem::path> images{};
    std::vector<std::string> videos{}, folders{}, others{};
};
FolderOfImages look_into(const std::filesystem::path& folder);

}  // namespace fidservo
