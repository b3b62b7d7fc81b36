// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Counts the frames that were to be read, by what became of them.
#include "src/images/image_frame.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// The first few names, without their folders.
std::string first_names(std::span<const std::string> names);

/// Counts frames that were read and names those that were left out. A frame is damaged as one of a live
/// camera's (vision/camera.h): cut short, or not to be decoded.
class ImageTally {
  public:
    /// @param missing  names of frames that are listed and do not exist
    explicit ImageTally(std::vector<std::string> missing) : missing_(std::move(missing)) {}

    /// Counts a frame after load().
    void add(const ImageFrame& frame);

    std::size_t read() const { return read_; }
    std::size_t all() const { return read_ + damaged_.size() + missing_.size(); }

    /// "4 of 5 images; 1 listed and not there: 3.png"; "5 images" if none was left out.
    std::string text() const;
    /// Why the first damaged frame cannot be read, in one line; or else that the first missing one does not
    /// exist.
    std::string first_reason() const;
    /// Notes for the user on the frames that were read. One line each.
    std::vector<std::string> notes() const;

  private:
    std::vector<std::string> missing_;
    std::vector<std::string> damaged_;
    std::string first_damage_;
    std::size_t read_ = 0;
    std::vector<std::string> turned_, with_more_;
};

}  // namespace fidservo
