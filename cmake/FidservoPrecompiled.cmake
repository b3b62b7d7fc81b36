# SPDX-License-Identifier: GPL-3.0-or-later
# What most files include, compiled once. A set of headers a kind of target: what is precompiled is read by every source,
# and what only some need would cost the others more than it saves them.
#
# Sources are also compiled in groups of a few, as one (unity), so that what they include beyond this, and the templates
# that they share, are compiled once a group. A name in an anonymous namespace is then seen by its whole group: it may be
# there once. Both hide an include that is missing; lint compiles every source alone, without them.

option(FIDSERVO_PRECOMPILED "Precompiled headers" ON)
option(FIDSERVO_GROUPED "Sources compiled in groups" ON)

# g++ takes a precompiled header only where these macros are as they were when it was made.
target_compile_definitions(fidservo_compile_options INTERFACE FMT_SHARED SPDLOG_SHARED_LIB SPDLOG_COMPILED_LIB SPDLOG_FMT_EXTERNAL)
target_compile_definitions(fidservo_test_options INTERFACE GTEST_HAS_PTHREAD=1)

# fidservo_precompiled(NAME OPTIONS target LIBRARIES targets... HEADERS <a> <b>...): a set of precompiled headers.
function(fidservo_precompiled name)
  cmake_parse_arguments(ARG "" "OPTIONS" "LIBRARIES;HEADERS" ${ARGN})
  if(NOT FIDSERVO_PRECOMPILED)
    return()
  endif()
  add_library(fidservo_precompiled_${name} OBJECT ${CMAKE_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(fidservo_precompiled_${name} PRIVATE ${ARG_OPTIONS} ${ARG_LIBRARIES})
  target_precompile_headers(fidservo_precompiled_${name} PRIVATE ${ARG_HEADERS})
endfunction()

# fidservo_compiled_with(TARGET SET GROUP): takes the precompiled headers of SET and compiles GROUP sources as one.
function(fidservo_compiled_with target set group)
  if(FIDSERVO_PRECOMPILED)
    # Headers are precompiled position-independent; of programs CMake would ask for the weaker kind.
    get_target_property(kind ${target} TYPE)
    if(kind STREQUAL EXECUTABLE)
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
    target_precompile_headers(${target} REUSE_FROM fidservo_precompiled_${set})
  endif()
  if(FIDSERVO_GROUPED AND group GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${group})
  endif()
endfunction()

set(fidservo_standard_headers
  <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <mutex> <numbers>
  <optional> <ranges> <span> <sstream> <string> <string_view> <utility> <vector>)

fidservo_precompiled(rooms OPTIONS fidservo_compile_options LIBRARIES Eigen3::Eigen fmt::fmt opencv_core
  HEADERS ${fidservo_standard_headers}
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry> <Eigen/LU> <Eigen/QR> <fmt/format.h> <opencv2/core.hpp> <tl/expected.hpp>)
fidservo_precompiled(program OPTIONS fidservo_compile_options
  LIBRARIES Eigen3::Eigen fmt::fmt opencv_core nlohmann_json::nlohmann_json spdlog::spdlog
  HEADERS ${fidservo_standard_headers}
    <Eigen/Core> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp> <opencv2/core.hpp> <spdlog/spdlog.h> <tl/expected.hpp>)
if(BUILD_TESTING)
  fidservo_precompiled(tests OPTIONS fidservo_test_options LIBRARIES Eigen3::Eigen fmt::fmt opencv_core GTest::gmock
    HEADERS ${fidservo_standard_headers}
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h>
    <opencv2/core.hpp> <tl/expected.hpp>)
endif()
