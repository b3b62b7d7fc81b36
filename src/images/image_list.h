// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Lists the frames of the user's image inputs, without decoding any.
#include "src/images/grey_range.h"
#include "src/images/image_frame.h"
#include "src/images/image_names.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// Frames that belong together.
struct ImageSeries {
    std::string name{};                  ///< file or folder; of images given by name the first one's file
    std::size_t files_by_name = 0;       ///< how many images were given by name; 0: it is no series of those
    std::vector<ImageFrame> frames{};    ///< without missing ones
    std::vector<DeepImage> deep{};       ///< those with samples of possibly more than 8 bits
    std::vector<std::string> missing{};  ///< names of frames that an index lists and that do not exist
    std::filesystem::path video{};       ///< the video's file, if it is one
};

struct ImageList {
    std::vector<ImageSeries> series;
    std::vector<std::string> notes;  ///< one line each: what was skipped, where times come from
};

/// The frames of inputs, in order:
///   a folder with cam0/data.csv or mav0/cam0/data.csv (EuRoC), or such a cam0 itself: the index's frames,
///   with their times;
///   a folder with rgb.txt and the folder rgb (TUM): the list's frames, with their times;
///   a folder of such recordings of EuRoC's: each of them;
///   a folder of images: those, in natural order of their names, TIFFs page by page; what else is in it is
///   passed over and noted;
///   a folder without images that holds one folder camN of images (kalibr's): that;
///   a video, by its ending;
///   all other files together: images and stacks, in the order in which they are given, as one series, whose
///   place is that of the first of them.
/// Images are told by their ending, others by what they begin with. Names of images may be times (NameTimes).
/// Throws InputError: there is no such input, or no image in it, or it is a pipe or a device, or one of
/// several cameras would have to be guessed, or a name is not a time though `name_times` says so.
ImageList list_images(std::span<const std::filesystem::path> inputs, NameTimes name_times);

/// What a series is called in a line for the user.
std::string title_of(const ImageSeries& series);

/// The images of a folder, in natural order, and the names of everything else in it.
struct FolderOfImages {
    std::vector<std::filesystem::path> images{};
    std::vector<std::string> videos{}, folders{}, others{};
};
FolderOfImages look_into(const std::filesystem::path& folder);

}  // namespace fidservo
