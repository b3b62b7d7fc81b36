// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/demand.h"
#include "vision/images/image_file.h"

#include <memory>

#include <turbojpeg.h>

namespace fidservo::vision {

std::vector<unsigned char> encode_jpeg(const cv::Mat& grey, int quality) {
    FIDSERVO_DEMAND(grey.type() == CV_8UC1 && !grey.empty());
    const std::unique_ptr<void, int (*)(tjhandle)> turbo(tjInitCompress(), &tjDestroy);
    FIDSERVO_DEMAND(turbo != nullptr);
    std::vector<unsigned char> jpeg(tjBufSize(grey.cols, grey.rows, TJSAMP_GRAY));
    unsigned char* to = jpeg.data();
    unsigned long size = jpeg.size();
    const int failed =
        tjCompress2(turbo.get(), grey.data, grey.cols, static_cast<int>(grey.step[0]), grey.rows, TJPF_GRAY,
                    &to, &size, TJSAMP_GRAY, quality, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
    FIDSERVO_DEMAND(failed == 0);
    jpeg.resize(size);
    return jpeg;
}

}  // namespace fidservo::vision
