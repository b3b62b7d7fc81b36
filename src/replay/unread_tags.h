// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Messages for images in which no or few tags were found.
#include "vision/tags/other_readings.h"
#include "vision/tags/tag_book.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

/// A sample of images, evenly spread over a sequence, with the number of tags found in each.
class FrameSample {
  public:
    struct Image {
        cv::Mat grey;
        std::size_t tags;
        bool is_thorough;
    };

    /// Offers the next image of the sequence, CV_8UC1, to the sample.
    /// @param is_thorough  the tags are those of a search with vision::thorough_options()
    void offer(const cv::Mat& grey, std::size_t tags, bool is_thorough = false);
    const std::vector<Image>& images() const { return images_; }
    std::vector<cv::Mat> greys() const;
    /// Of all images; nothing if some were not searched thoroughly.
    std::optional<std::size_t> tags_by_thorough_search() const;

  private:
    std::vector<Image> images_;
    std::size_t offered_ = 0, every_ = 1;
};

/// How the options of `replay` ask for a reading of tags, where it differs from the one that was tried:
/// "--family tag25h9 --mirrored".
std::string options_for(const vision::TagReading& reading, const vision::TagReading& tried);

/// "36 tags of tag36h11 with a border of two cells".
std::string tags_text(const vision::TriedReading& found);

/// What the images show, if no reading finds more tags; one line.
std::string what_was_seen_text(const vision::OtherReadings& others, const vision::TagReading& tried);

/// Nothing if most squares that look like tags were read. Else the reading that would find more, which was
/// tried on the sample; where there is none and no tag was found at all, what is to be seen. A line each.
std::vector<std::string> unread_tags_text(const FrameSample& sample, std::size_t tags_in_all,
                                          const vision::TagReading& tried);

}  // namespace fidservo
