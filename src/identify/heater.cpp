#include "core/failure.h"
#include "src/identify/identify.h"

namespace fidservo {

Identified identify_heater(const IdentifyInput&) {
    throw InputError("identify heater: not built in");
}

}  // namespace fidservo
