#include "core/failure.h"
#include "src/identify/identify.h"

namespace fidservo {

Identified calibrate_hall(const IdentifyInput&) {
    throw InputError("calibrate hall: not built in");
}

}  // namespace fidservo
