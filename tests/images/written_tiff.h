// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// TIFFs for tests, written with libtiff.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::testing {

struct TiffPage {
    cv::Mat samples{};    ///< CV_16UC1 or CV_16UC3: values below 2^bits
    int bits = 8;         ///< 1, 4, 8, or 9 to 16; samples of other than 8 or 16 bits are packed
    int compression = 1;  ///< libtiff's number
    int photometric = 1;  ///< 0: 0 is white, 1: 0 is black, 2: red, green, blue, 3: by a palette
    bool is_tiled = false;
    bool is_planar = false;         ///< colours in separate planes
    bool is_reduced = false;        ///< a smaller copy of another page
    bool has_subdirectory = false;  ///< the next page is a subdirectory of it
    int orientation = 1;
    int rows_per_strip = 7;
    std::string description{};  ///< empty: none
    int depth = 1;              ///< its tag ImageDepth
    int metamorph_planes = 0;   ///< how many its tag UIC2 counts; 0: it has none
};

/// @param mode  libtiff's: "w" with "l" or "b" for the order of bytes, "8" for BigTIFF
void write_tiff(const std::filesystem::path& file, const std::string& mode,
                const std::vector<TiffPage>& pages);

}  // namespace fidservo::testing
