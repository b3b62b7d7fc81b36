#include "core/failure.h"
#include "src/identify/identify.h"

namespace fidservo {

Identified identify_hysteresis(const IdentifyInput&) {
    throw InputError("identify hysteresis: not built in");
}

}  // namespace fidservo
