#include "core/failure.h"
#include "src/identify/identify.h"

namespace fidservo {

Identified identify_macro(const IdentifyInput&) {
    throw InputError("identify macro: not built in");
}

}  // namespace fidservo
