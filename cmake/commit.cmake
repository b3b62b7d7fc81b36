# SPDX-License-Identifier: GPL-3.0-or-later
# Writes FILE, the source of src/process/commit.h, with what git calls the commit in SOURCE; "unknown" without git.
set(commit "unknown")
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${FILE} @ONLY CONTENT [[#include "src/process/commit.h"

namespace fidservo {

const char* program_version() {
    return "@VERSION@";
}

const char* built_from_commit() {
    return "@commit@";
}

}  // namespace fidservo
]])
