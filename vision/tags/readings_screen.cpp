// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/readings_screen.h"

#include "core/demand.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_pattern.h"

#include <algorithm>
#include <array>

extern "C" {
#include <apriltag/apriltag.h>
}

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {

struct ReadingsScreen::Impl {
    struct SeenAs {
        std::size_t reading;
        int tag_id;
        std::array<Eigen::Vector2d, 4> corners_px;
    };

    explicit Impl(const std::vector<TagReading>& of) : readings(of) {
        constexpr int faintest_edge = 5;
        for (const TagReading& reading : readings) {
            books.push_back(shared_tag_book(reading, 0));
            least.push_back(least_explained(*reading.print.family));
        }
        std::vector<std::shared_ptr<apriltag_family>> black, white;
        for (std::size_t k = 0; k < readings.size(); ++k)
            if (readings[k].print.border_cells == 2)
                (books[k]->reversed_border ? white : black).push_back(books[k]);
        detector = library_detector(books, faintest_edge);
        of_black_borders = library_detector(black, faintest_edge);
        of_white_borders = library_detector(white, faintest_edge);
    }

    /// Adds what is in an image and not among `all` yet.
    void search(const LibraryDetector& with, const cv::Mat& image, double magnification,
                std::vector<SeenAs>& all) const {
        constexpr double library_px = 0.5;
        image_u8_t view{image.cols, image.rows, static_cast<int>(image.step[0]), image.data};
        const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> found(
            apriltag_detector_detect(with.get(), &view), apriltag_detections_destroy);
        for (int k = 0; k < zarray_size(found.get()); ++k) {
            apriltag_detection_t* tag = nullptr;
            zarray_get(found.get(), k, static_cast<void*>(&tag));
            const auto book = std::ranges::find(books, tag->family, &std::shared_ptr<apriltag_family>::get);
            SeenAs seen{static_cast<std::size_t>(book - books.begin()), tag->id, {}};
            const TagReading& reading = readings[seen.reading];
            for (std::size_t c = 0; c < 4; ++c)
                seen.corners_px[c] = Eigen::Vector2d(tag->p[c][0] - library_px, tag->p[c][1] - library_px);
            if (reading.mirrored) seen.corners_px = mirrored(seen.corners_px);
            const TagPattern pattern = tag_pattern(reading.print, seen.tag_id);
            if (!is_convincing(image, seen.corners_px, pattern, least[seen.reading])) continue;
            for (Eigen::Vector2d& corner : seen.corners_px) corner /= magnification;
            if (std::ranges::none_of(all, [&](const SeenAs& other) {
                    return other.reading == seen.reading && same_place(other.corners_px, seen.corners_px);
                }))
                all.push_back(seen);
        }
    }

    std::vector<TagReading> readings;
    std::vector<std::shared_ptr<apriltag_family>> books;
    std::vector<LeastExplained> least;
    LibraryDetector detector;                            ///< of all books
    LibraryDetector of_black_borders, of_white_borders;  ///< of two cells
};

ReadingsScreen::ReadingsScreen(const std::vector<TagReading>& readings)
    : impl_(std::make_unique<Impl>(readings)) {}
ReadingsScreen::~ReadingsScreen() = default;

std::vector<std::size_t> ReadingsScreen::seen_in(const cv::Mat& image) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    constexpr int least_px = 10;
    std::vector<std::size_t> seen;
    if (std::min(image.cols, image.rows) < least_px) return seen;
    std::vector<Impl::SeenAs> tags;
    impl_->search(impl_->detector, image, 1.0, tags);
    cv::Mat larger, changed;
    cv::resize(image, larger, {}, 2.0, 2.0, cv::INTER_CUBIC);
    impl_->search(impl_->detector, larger, 2.0, tags);
    // Squares that touch a tag's corners, as an AprilGrid's do, are torn off by wider paper, be it white or
    // black.
    cv::dilate(larger, changed, cv::Mat());
    impl_->search(impl_->of_black_borders, changed, 2.0, tags);
    cv::erode(larger, changed, cv::Mat());
    impl_->search(impl_->of_white_borders, changed, 2.0, tags);
    for (const Impl::SeenAs& tag : tags) seen.push_back(tag.reading);
    return seen;
}

}  // namespace fidservo::vision
