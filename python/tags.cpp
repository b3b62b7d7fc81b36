// SPDX-License-Identifier: GPL-3.0-or-later
// TagFinder: fiducials in an image, with the covariance of their places.
#include "core/input_error.h"
#include "python/bindings.h"
#include "src/replay/tag_finder.h"
#include "src/replay/tag_options.h"
#include "vision/images/image_file.h"

#include <cstdint>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

/// Calls from several threads wait for each other.
struct SharedFinder {
    TagFinder finder;
    bool is_of_machine;
    std::mutex in_use = {};
};

/// The array itself where the bytes of its values are in the machine's order, else a copy in which they are.
template <class Value>
py::array_t<Value> in_order_of_machine(const py::array& array) {
    auto ordered = py::array_t<Value>::ensure(array);
    if (!ordered) throw std::bad_alloc();
    return ordered;
}

/// An image of the array's own memory where its rows are whole, else of a copy.
struct ArrayImage {
    py::array array;
    cv::Mat image;
};

ArrayImage image_of(const py::object& given) {
    auto [array, mask] = array_of("image", given);
    if (mask) throw py::value_error("image: has masked pixels; must be filled");
    const char kind = array.dtype().kind();
    const auto bytes = array.itemsize();
    if (array.ndim() != 2 || kind != 'u' || (bytes != 1 && bytes != 2))
        throw py::type_error(
            "image: must be a grey image: an array of uint8 or uint16 of two dimensions, height x width");
    const auto height = array.shape(0), width = array.shape(1);
    if (height == 0 || width == 0) throw py::value_error("image: has no pixel");
    const Status is_readable =
        vision::demand_readable_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    if (!is_readable) throw InputError("image: " + is_readable.error().text);
    array = bytes == 1 ? py::array(in_order_of_machine<std::uint8_t>(array))
                       : py::array(in_order_of_machine<std::uint16_t>(array));
    if (array.strides(1) != bytes || array.strides(0) < width * bytes || array.strides(0) % bytes != 0)
        array = py::array::ensure(array, py::array::c_style);
    if (!array) throw std::bad_alloc();
    cv::Mat image(static_cast<int>(height), static_cast<int>(width), bytes == 1 ? CV_8UC1 : CV_16UC1,
                  const_cast<void*>(array.data()), static_cast<std::size_t>(array.strides(0)));
    return {std::move(array), std::move(image)};
}

cv::Mat in_8_bits(const cv::Mat& image) {
    if (image.depth() == CV_8U) return image;
    const vision::StoredImage stored{.grey = image};
    return vision::to_8_bits(stored, vision::bits_of(stored));
}

std::unique_ptr<SharedFinder> make_finder(const HeldRig* rig, const std::string& family, int border_cells,
                                          bool inverted, bool mirrored, bool photograph) {
    const TagOptions options{.name_times = {},
                             .family = family,
                             .border_cells = border_cells,
                             .inverted = inverted,
                             .mirrored = mirrored};
    const TagPrint print = rig != nullptr && rig->rig.fiducials ? rig->rig.fiducials->print : TagPrint{};
    return std::unique_ptr<SharedFinder>(new SharedFinder{
        TagFinder(rig == nullptr ? std::nullopt : rig->rig.camera, reading_of(options, print)), !photograph});
}

/// Works on an image without Python's lock.
template <class Work>
auto on_image(SharedFinder& shared, const py::object& array, const Work& work) {
    const ArrayImage given = image_of(array);
    const py::gil_scoped_release others_may_run;
    const std::lock_guard lock(shared.in_use);
    return work(in_8_bits(given.image));
}

std::vector<TagDetection> detect(SharedFinder& shared, const py::object& array) {
    return on_image(shared, array, [&](const cv::Mat& image) {
        return shared.finder.detect(image, 0, shared.is_of_machine);
    });
}

std::vector<vision::RefinedTag> measure(SharedFinder& shared, const py::object& array) {
    return on_image(shared, array, [&](const cv::Mat& image) {
        return shared.finder.measure(image, 0, shared.is_of_machine).refined;
    });
}

Eigen::Matrix<double, 4, 2> corners_of(const TagDetection& tag) {
    Eigen::Matrix<double, 4, 2> corners;
    for (std::size_t k = 0; k < tag.corners_px.size(); ++k)
        corners.row(static_cast<Eigen::Index>(k)) = tag.corners_px[k].transpose();
    return corners;
}

void bind_results(py::module_& module) {
    using vision::RefinedTag;
    py::class_<TagDetection>(module, "Detection", "A fiducial as the detector found it, to 0.2 px or so.")
        .def_readonly("tag_id", &TagDetection::tag_id, "By the family's code book.")
        .def_property_readonly(
            "family", [](const TagDetection& tag) { return std::string(tag.print.family->name); },
            "As which it was read.")
        .def_readonly("corrected_bits", &TagDetection::corrected_bits,
                      "Code bits that differ from the code book.")
        .def_readonly("decision_margin", &TagDetection::decision_margin,
                      "Contrast between black and white bits, grey levels.")
        .def_property_readonly("corners_px", &corners_of,
                               "4 x 2, px: u and v, pixel centres at integers, in the order (-,+), (+,+), "
                               "(+,-), (-,-) in plate x, y.");
    py::class_<RefinedTag>(module, "Tag", "A fiducial measured along all edges of its code.")
        .def_property_readonly(
            "tag_id", [](const RefinedTag& tag) { return tag.detection.tag_id; },
            "By the family's code book.")
        .def_property_readonly(
            "family", [](const RefinedTag& tag) { return std::string(tag.detection.print.family->name); },
            "As which it was read.")
        .def_property_readonly(
            "corners_px", [](const RefinedTag& tag) { return corners_of(tag.detection); },
            "4 x 2, px: as of Detection.")
        .def_property_readonly(
            "covariance_px2", [](const RefinedTag& tag) { return tag.covariance_px2; },
            "8 x 8, px^2: of u0, v0, u1, v1, ...; corners share edges, so it is not diagonal.")
        .def_property_readonly(
            "centre_px", [](const RefinedTag& tag) { return tag.centre_px; }, "Image of its centre, px.")
        .def_property_readonly(
            "centre_covariance_px2", [](const RefinedTag& tag) { return tag.centre_covariance_px2; },
            "2 x 2, px^2.")
        .def_readonly("explained", &RefinedTag::explained,
                      "Share of the edges' length that looks like this tag, 0 to 1; the rest was left out.")
        .def_readonly("blur_px", &RefinedTag::blur_px,
                      "Standard deviation of the edges' profiles, optics and pixel together, px.")
        .def_readonly("ink_spread_px", &RefinedTag::ink_spread_px,
                      "By which every black edge reaches farther out than the code says, px.")
        .def_readonly("misfit", &RefinedTag::misfit,
                      "Mean square of what the model leaves, in variances of the noise: 1 if it fits.")
        .def_readonly("fits", &RefinedTag::fits,
                      "Whether that can be noise alone, at 1 %; if not, covariances are widened.")
        .def_readonly("camera_known", &RefinedTag::camera_known,
                      "Whether perspective and distortion are those of the rig's camera.");
}

}  // namespace

void bind_tags(py::module_& module) {
    bind_results(module);
    py::class_<SharedFinder>(module, "TagFinder",
                             "Looks for fiducials, as `fidservo replay` does. Threads may share one, but "
                             "then wait for each other.")
        .def(py::init(&make_finder), py::kw_only(), py::arg("rig") = nullptr, py::arg("family") = "",
             py::arg("border_cells") = 0, py::arg("inverted") = false, py::arg("mirrored") = false,
             py::arg("photograph") = true,
             "rig: whose fiducials they are, and whose camera took images of its size: that helps to "
             "measure.\n"
             "family: tag36h11 and others (fidservo replay --help); '': the rig's.\n"
             "border_cells: width of the tags' border; 0: the rig's, 1.\n"
             "inverted: the tags are white on black.\n"
             "mirrored: the images are.\n"
             "photograph: look for every tag, however small; else for large, well lit ones, as the machine's "
             "own "
             "camera sees them, in a tenth of the time.\n\n"
             "Raises InputError.")
        .def("detect", &detect, py::arg("image"),
             "The fiducials in a grey image, height x width of uint8 or uint16, by id. Of uint16, the fewest "
             "bits that hold the largest value are full scale.")
        .def(
            "measure", &measure, py::arg("image"),
            "The same, measured to some hundredths of a pixel, with their covariance; without those that are "
            "too small (24 px a side) or too hidden.");
}

}  // namespace fidservo::python
