# What most files include, compiled once: for the tests, and in the sanitizers' builds for everything. Elsewhere every
# file has to include what it uses, which this would hide, and g++ 12 at -O3 would warn of bounds in std::string that it
# otherwise knows to be false.

add_library(fidservo_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
target_link_libraries(fidservo_precompiled PRIVATE
  fidservo_test_options Eigen3::Eigen fmt::fmt opencv_core GTest::gmock)
target_precompile_headers(fidservo_precompiled PRIVATE
  <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <limits> <map> <memory> <numbers> <optional> <span>
  <sstream> <string> <vector>
  <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h>
  <opencv2/core.hpp> <tl/expected.hpp>)

# g++ takes a precompiled header only where these macros are as they were when it was made.
set(fidservo_precompiled_macros FMT_SHARED GTEST_HAS_PTHREAD=1)
target_compile_definitions(fidservo_test_options INTERFACE ${fidservo_precompiled_macros})
if(FIDSERVO_PRECOMPILED)
  target_compile_definitions(fidservo_compile_options INTERFACE ${fidservo_precompiled_macros})
endif()
