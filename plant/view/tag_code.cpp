#include "plant/view/tag_code.h"

#include "core/input_error.h"

#include <memory>
#include <string>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

namespace fidservo::plant::view {

CellPattern tag_pattern(std::string_view family, int id) {
    if (family != "tag36h11") {
        throw InputError("plate: family: '" + std::string(family) + "' is not known; allowed: tag36h11");
    }
    const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> book(tag36h11_create(),
                                                                               &tag36h11_destroy);
    if (id < 0 || id >= static_cast<int>(book->ncodes)) {
        throw InputError("plate: tag id " + std::to_string(id) + " is not in tag36h11; allowed: 0.." +
                         std::to_string(book->ncodes - 1));
    }
    const int side = book->width_at_border;
    CellPattern pattern{side, side, std::vector<std::uint8_t>(static_cast<std::size_t>(side) * side, 1)};
    const std::uint64_t code = book->codes[id];
    for (std::uint32_t bit = 0; bit < book->nbits; ++bit) {
        const bool white = ((code >> (book->nbits - 1 - bit)) & 1U) != 0;
        if (white) pattern.inked[book->bit_y[bit] * side + book->bit_x[bit]] = 0;
    }
    return pattern;
}

}  // namespace fidservo::plant::view
