// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The list of a camera folder's images and their times as other programs write it (EuRoC's data.csv, TUM's
// rgb.txt), also after editing in a text editor or a spreadsheet.
#include "core/recording.h"

#include <filesystem>
#include <vector>

namespace fidservo {

/// Reads a table (src/files/table/plain_table.h) of times and names of images, with titles or without.
///
/// Times are whole ns; in another unit where the title names it: [us], [ms], [s]. Without a unit, numbers of
/// 19 digits are ns since 1970, and numbers of 10 digits with decimals are seconds since 1970. Any other
/// number is refused, as are times that do not rise, and times that rise by 1 ns from image to image, as
/// numbers of frames do.
///
/// Names are those of files in the folder `data` beside the index, where they are there; a path is looked for
/// from the index on, then by its last part in `data` and beside the index, which is said. A file that is not
/// in `data` comes back as an absolute path, one that is nowhere as it is written. A last line without an end
/// is whole if it names a file that is there.
/// @throws InputError "FILE:LINE: ..."; also on two rows with one name
std::vector<FrameName> read_frame_index(const std::filesystem::path& file);

}  // namespace fidservo
