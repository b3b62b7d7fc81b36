// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The functions behind the module's table in vision/images/media.h.
#include "vision/images/media.h"

namespace fidservo::vision {

Result<std::vector<PageOfFile>> tiff_pages(const char* file);
Result<StoredImage> tiff_page(const char* file, std::uint64_t page);
Result<std::unique_ptr<Video>> ffmpeg_video(const char* file);

}  // namespace fidservo::vision
