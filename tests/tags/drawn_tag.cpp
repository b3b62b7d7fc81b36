// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tags/drawn_tag.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string_view>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>
}

namespace fidservo::testing {
namespace {

struct LibraryFamily {
    apriltag_family_t* (*create)();
    void (*destroy)(apriltag_family_t*);
};

const std::map<std::string_view, LibraryFamily> library_families{
    {"tag36h11", {tag36h11_create, tag36h11_destroy}},
    {"tag25h9", {tag25h9_create, tag25h9_destroy}},
    {"tag16h5", {tag16h5_create, tag16h5_destroy}},
    {"tagStandard41h12", {tagStandard41h12_create, tagStandard41h12_destroy}}};

cv::Ptr<cv::aruco::Dictionary> dictionary_of(std::string_view name) {
    const int bits = name.at(5) - '4';
    const std::map<std::string_view, int> sizes{{"50", 0}, {"100", 1}, {"250", 2}, {"1000", 3}};
    return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50 + 4 * bits + sizes.at(name.substr(9)));
}

cv::Mat1b library_cells(std::string_view name, int id) {
    const LibraryFamily& of = library_families.at(name);
    apriltag_family_t* family = of.create();
    image_u8_t* drawn = apriltag_to_image(family, id);
    const cv::Mat1b all(drawn->height, drawn->width, drawn->buf, static_cast<std::size_t>(drawn->stride));
    const int paper = name == "tagStandard41h12" ? 0 : 1;
    const int side = drawn->width - 2 * paper;
    cv::Mat1b cells = all(cv::Rect(paper, paper, side, side)).clone();
    std::free(drawn->buf);
    std::free(drawn);
    of.destroy(family);
    return cells;
}

std::vector<cv::Point2f> points_of(const std::array<Eigen::Vector2d, 4>& corners) {
    std::vector<cv::Point2f> points;
    for (const Eigen::Vector2d& corner : corners)
        points.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    return points;
}

}  // namespace

cv::Mat1b cells_of(const TagPrint& print, int id) {
    cv::Mat1b cells;
    if (library_families.contains(print.family->name)) {
        cells = library_cells(print.family->name, id);
        if (print.border_cells == 2)
            cv::copyMakeBorder(cells, cells, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    } else {
        const auto dictionary = dictionary_of(print.family->name);
        cv::aruco::drawMarker(dictionary, id, dictionary->markerSize + 2 * print.border_cells, cells,
                              print.border_cells);
    }
    if (print.inverted) cells = cv::Mat1b(255 - cells);
    return cells;
}

DrawnSize size_of(const TagPrint& print) {
    const int all = cells_of(print, 0).cols;
    return {print.family->name == "tagStandard41h12" ? 5 : all, all};
}

cv::Mat1b draw(const std::vector<DrawnTag>& tags, cv::Size size_px, double blur_px, std::mt19937_64& random) {
    constexpr int fine = 6, texels = 32;
    const bool inverted = !tags.empty() && tags.front().reading.print.inverted;
    const double white = between(190.0, 240.0, random), black = between(15.0, 60.0, random);
    cv::Mat1b sheet(size_px * fine, inverted ? 0 : 255);
    for (const DrawnTag& tag : tags) {
        cv::Mat1b cells = cells_of(tag.reading.print, tag.id);
        const DrawnSize size = size_of(tag.reading.print);
        // Two cells of paper around, in whose corners an AprilGrid's squares stand.
        const int room = 2;
        cv::copyMakeBorder(cells, cells, room, room, room, room, cv::BORDER_CONSTANT,
                           cv::Scalar(inverted ? 0 : 255));
        const int last = cells.cols - room;
        if (tag.corner_squares)
            for (const int row : {0, last})
                for (const int column : {0, last})
                    cells(cv::Rect(column, row, room, room)).setTo(inverted ? 255 : 0);
        cv::Mat1b texture;
        cv::resize(cells, texture, {}, texels, texels, cv::INTER_NEAREST);
        const double low = (room + 0.5 * (size.all - size.outline)) * texels - 0.5;
        const double high = low + size.outline * texels;
        const std::array<Eigen::Vector2d, 4> from{Eigen::Vector2d(low, high), Eigen::Vector2d(high, high),
                                                  Eigen::Vector2d(high, low), Eigen::Vector2d(low, low)};
        std::array<Eigen::Vector2d, 4> to;
        for (std::size_t k = 0; k < 4; ++k) to[k] = (tag.corners_px[k].array() + 0.5) * fine - 0.5;
        const cv::Mat map = cv::getPerspectiveTransform(points_of(from), points_of(to));
        cv::warpPerspective(texture, sheet, map, sheet.size(), cv::INTER_NEAREST, cv::BORDER_TRANSPARENT);
    }
    cv::Mat1f grey;
    cv::Mat1f fine_grey;
    sheet.convertTo(fine_grey, CV_32F, (white - black) / 255.0, black);
    cv::resize(fine_grey, grey, size_px, 0.0, 0.0, cv::INTER_AREA);
    cv::GaussianBlur(grey, grey, {}, blur_px);
    std::normal_distribution<float> noise(0.0F, 1.0F);
    for (float& value : grey) value += noise(random);
    cv::Mat1b image;
    grey.convertTo(image, CV_8U);
    return image;
}

TagPrint random_print(std::mt19937_64& random) {
    const auto families = tag_families();
    return {&families[static_cast<std::size_t>(one_of(static_cast<int>(families.size()), random))]};
}

std::array<Eigen::Vector2d, 4> random_corners(const Eigen::Vector2d& centre_px, double side_px, bool mirrored,
                                              std::mt19937_64& random) {
    const double angle = between(0.0, 2.0 * std::numbers::pi, random);
    const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
        const double across = (mirrored ? -1.0 : 1.0) * tag_corners[k].x();
        corners[k] = centre_px + 0.5 * side_px * (across * x + tag_corners[k].y() * y) +
                     0.05 * side_px * Eigen::Vector2d(between(-1.0, 1.0, random), between(-1.0, 1.0, random));
    }
    return corners;
}

}  // namespace fidservo::testing
