// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tries many readings of tags (family, border, inversion, mirroring) at a time.
#include "vision/tags/tag_book.h"

#include <cstddef>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Finds squares once and compares all readings with each of them. Faster than a search for each reading, but
/// a tag counts only if all of its bits are right.
class ReadingsScreen {
  public:
    explicit ReadingsScreen(const std::vector<TagReading>& readings);
    ~ReadingsScreen();

    /// For every tag found, the index of its reading.
    /// @param image  CV_8UC1
    std::vector<std::size_t> seen_in(const cv::Mat& image);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision
