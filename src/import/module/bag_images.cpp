// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/bag_images.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::imports {
namespace {

constexpr std::uint32_t longest_side_px = vision::most_side_px;

struct Encoding {
    std::string_view name;
    int type;        ///< of the matrix that the bytes are
    int conversion;  ///< to grey, as cv::cvtColor numbers it; -1: it is grey
};

constexpr std::array encodings{
    Encoding{"mono8", CV_8UC1, -1}, Encoding{"8UC1", CV_8UC1, -1}, Encoding{"mono16", CV_16UC1, -1},
    Encoding{"16UC1", CV_16UC1, -1}, Encoding{"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
    Encoding{"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY}, Encoding{"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
    Encoding{"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
    // OpenCV names the second row's second and third pixel, ROS the first row's.
    Encoding{"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2GRAY},
    Encoding{"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2GRAY},
    Encoding{"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2GRAY},
    Encoding{"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2GRAY}};

void swap_bytes_of_16(cv::Mat& image) {
    image.forEach<std::uint16_t>([](std::uint16_t& value, const int*) {
        constexpr unsigned byte = 8;
        value = static_cast<std::uint16_t>((value >> byte) | (value << byte));
    });
}

std::string shortest_list(const std::vector<double>& values) {
    return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

LoggedFrame frame_of_image(std::string_view message) {
    CdrReader cdr(message);
    read_header(cdr);
    const auto height = cdr.number<std::uint32_t>(), width = cdr.number<std::uint32_t>();
    const std::string name = cdr.text();
    const bool is_big = cdr.number<std::uint8_t>() != 0;
    const std::size_t step = cdr.number<std::uint32_t>();
    const std::string_view data = cdr.octets();
    const auto encoding = std::ranges::find(encodings, name, &Encoding::name);
    if (encoding == encodings.end())
        throw CdrError(fmt::format(
            "encoding '{}': allowed: mono8, mono16, 8UC1, 16UC1, rgb8, bgr8, rgba8, bgra8, bayer_ and rggb8, "
            "bggr8, gbrg8 or grbg8",
            name.substr(0, 40)));
    if (width == 0 || height == 0 || width > longest_side_px || height > longest_side_px)
        throw CdrError(
            fmt::format("{} x {} px: sides of 1 to {} px are read", width, height, longest_side_px));
    if (step < width * CV_ELEM_SIZE(encoding->type) || step * height > data.size())
        throw CdrError(fmt::format("{} x {} px of {} in rows of {} bytes, but {} bytes", width, height, name,
                                   step, data.size()));
    const cv::Mat raw(static_cast<int>(height), static_cast<int>(width), encoding->type,
                      const_cast<char*>(data.data()), step);
    LoggedFrame frame;
    cv::Mat& grey = frame.image.grey;
    if (encoding->conversion < 0)
        raw.copyTo(grey);
    else if (encoding->type == CV_8UC1 && (width < 3 || height < 3))
        throw CdrError("a Bayer pattern of fewer than 3 x 3 px");
    else
        cv::cvtColor(raw, grey, encoding->conversion);
    if (encoding->type == CV_16UC1 && is_big == (std::endian::native == std::endian::little))
        swap_bytes_of_16(grey);
    return frame;
}

bool is_deep_image(std::string_view message) {
    CdrReader cdr(message);
    read_header(cdr);
    cdr.number<std::uint32_t>();
    cdr.number<std::uint32_t>();
    const auto encoding = std::ranges::find(encodings, cdr.text(), &Encoding::name);
    return encoding != encodings.end() && encoding->type == CV_16UC1;
}

LoggedFrame frame_of_compressed(std::string_view message) {
    CdrReader cdr(message);
    read_header(cdr);
    const std::string format = cdr.text();
    const std::string_view data = cdr.octets();
    if (data.starts_with("\x89PNG")) return {.image = {}, .bytes = std::string(data), .ending = ".png"};
    if (data.starts_with("\xFF\xD8\xFF")) return {.image = {}, .bytes = std::string(data), .ending = ".jpg"};
    throw CdrError(fmt::format("format '{}': is neither PNG nor JPEG", format.substr(0, 40)));
}

std::string text_of_camera_info(std::string_view message) {
    CdrReader cdr(message);
    read_header(cdr);
    const auto height = cdr.number<std::uint32_t>(), width = cdr.number<std::uint32_t>();
    const std::string model = cdr.text();
    const std::vector<double> d = cdr.doubles();
    constexpr std::size_t of_matrix = 9, of_projection = 12;
    const std::vector<double> k = cdr.doubles(of_matrix), r = cdr.doubles(of_matrix),
                              p = cdr.doubles(of_projection);
    const auto binning_x = cdr.number<std::uint32_t>(), binning_y = cdr.number<std::uint32_t>();
    std::array<std::uint32_t, 4> roi{};
    for (std::uint32_t& value : roi) value = cdr.number<std::uint32_t>();
    const bool does_rectify = cdr.number<std::uint8_t>() != 0;
    if (!std::ranges::all_of(model, [](char letter) {
            return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
        }))
        throw CdrError("its distortion_model is no word");
    return fmt::format(
        "# CameraInfo of a bag of ROS 2\nheight: {}\nwidth: {}\ndistortion_model: \"{}\"\nd: {}\nk: {}\nr: "
        "{}\np: {}\n"
        "binning_x: {}\nbinning_y: {}\nroi: {{ x_offset: {}, y_offset: {}, height: {}, width: {}, "
        "do_rectify: {} }}\n",
        height, width, model, shortest_list(d), shortest_list(k), shortest_list(r), shortest_list(p),
        binning_x, binning_y, roi[0], roi[1], roi[2], roi[3], does_rectify);
}

}  // namespace fidservo::imports
