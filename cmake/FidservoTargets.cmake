# SPDX-License-Identifier: GPL-3.0-or-later
# How every room of the house is compiled. Warnings are errors.

# -O3 is for what a diagnosis follows by the million (FAST) and for loops over pixels, by source; elsewhere it only takes
# longer to compile.
string(REPLACE "-O3" "-O2" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")

set(FIDSERVO_SANITIZE "" CACHE STRING "Sanitizers for everything: address,undefined or thread")

add_library(fidservo_compile_options INTERFACE)
target_include_directories(fidservo_compile_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(fidservo_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND FIDSERVO_GROUPED)
  # The compiler looks for what it no longer needs at every 128 MB; above a GB is often enough, and a tenth faster.
  target_compile_options(fidservo_compile_options INTERFACE --param=ggc-min-heapsize=1000000)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(fidservo_compile_options INTERFACE -Wno-restrict) # false positives of g++ 12 in std::string
endif()
if(FIDSERVO_SANITIZE)
  target_compile_options(fidservo_compile_options INTERFACE
    -fsanitize=${FIDSERVO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ follows the values less well through what the sanitizers insert, and says so of std::optional.
    target_compile_options(fidservo_compile_options INTERFACE -Wno-maybe-uninitialized)
  endif()
  if(FIDSERVO_SANITIZE MATCHES address)
    # Eigen would put a header before each block here, as the packages' libraries, which share its templates, do not:
    # one would free what the other allocated.
    target_compile_definitions(fidservo_compile_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  if(FIDSERVO_SANITIZE MATCHES undefined)
    # A null dereference stops the address sanitizer's run anyway; these checks of every pointer double the build.
    target_compile_options(fidservo_compile_options INTERFACE -fno-sanitize=null,alignment,object-size)
  endif()
  target_link_options(fidservo_compile_options INTERFACE -fsanitize=${FIDSERVO_SANITIZE})
endif()

option(FIDSERVO_FUZZ "The fuzzers, of clang's libFuzzer, too" OFF)
if(FIDSERVO_FUZZ)
  target_compile_options(fidservo_compile_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# What tests spend their time in is in the libraries: for the tests themselves -O1 is enough.
add_library(fidservo_test_options INTERFACE)
target_link_libraries(fidservo_test_options INTERFACE fidservo_compile_options)
target_compile_options(fidservo_test_options INTERFACE $<$<CONFIG:Release>:-O1>)

# fidservo_library(NAME [FAST] [NOT_INSTALLED] [GROUP n] SOURCES a.cpp ... USES targets... [HEADERS a.h ...]): the one library
# target of a room; n sources are compiled as one. FAST: with all that the optimiser can. HEADERS: the room's interface, for
# those who use the installed library; it is what the page of the interfaces shows. NOT_INSTALLED: a library of tests.
function(fidservo_library name)
  cmake_parse_arguments(ARG "FAST;NOT_INSTALLED" "GROUP" "SOURCES;USES;PRIVATELY;HEADERS" ${ARGN})
  if(NOT ARG_GROUP)
    set(ARG_GROUP 16)
  endif()
  add_library(fidservo_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(fidservo_${name} PUBLIC $<BUILD_INTERFACE:fidservo_compile_options> ${ARG_USES} PRIVATE ${ARG_PRIVATELY})
  if(NOT ARG_NOT_INSTALLED)
    fidservo_export(${name} HEADERS ${ARG_HEADERS})
  endif()
  if(ARG_FAST)
    target_compile_options(fidservo_${name} PRIVATE $<$<CONFIG:Release>:-O3>)
  endif()
  fidservo_compiled_with(fidservo_${name} rooms ${ARG_GROUP})
endfunction()

# The allocator keeps what a diagnosis gives back, as in the program: the same bounds as in src/cli/main.cpp.
set(fidservo_test_environment "GLIBC_TUNABLES=glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=268435456:glibc.malloc.arena_max=1")

# fidservo_shards(NAME LABEL FILTER SECONDS MOST SERIAL): the cases of a test program that FILTER names, which take SECONDS of
# processor time, in as many processes as make each last MOST of them. ctest starts the costliest first, so that the end of all is
# not a long one on one core.
function(fidservo_shards name label filter seconds most serial)
  math(EXPR count "(${seconds} + ${most} - 1) / ${most}")
  if(serial)
    set(count 1)
  endif()
  math(EXPR last "${count} - 1")
  math(EXPR cost "1 + ${seconds} / ${count}")
  foreach(shard RANGE ${last})
    add_test(NAME ${name}.${label}.${shard} COMMAND ${name} --gtest_filter=${filter})
    set_tests_properties(${name}.${label}.${shard} PROPERTIES LABELS ${label} RUN_SERIAL ${serial} TIMEOUT 1500 COST ${cost}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${count};GTEST_SHARD_INDEX=${shard};${fidservo_test_environment}")
  endforeach()
endfunction()

# Notes sources that are in some test program; tests/CMakeLists.txt looks for those that are in none.
function(fidservo_in_a_test_program)
  foreach(source ${ARGN})
    cmake_path(ABSOLUTE_PATH source)
    set_property(GLOBAL APPEND PROPERTY FIDSERVO_TEST_SOURCES ${source})
  endforeach()
endfunction()

# fidservo_test(NAME [SERIAL] [QUICK_S n] [SLOW_S n] [SLOW_TOGETHER suites] SOURCES a.cpp ... USES targets...): one GoogleTest
# program.
# Cases of suites whose name begins with Slow are labelled slow, the others quick; a few processes run them all. Each
# case is a test of its own besides, with the label case: `ctest -L case -R NAME`.
# QUICK_S, SLOW_S: about how many seconds of processor time the cases take (default: 1 and 15), for a process of few seconds each.
# SLOW_TOGETHER: slow suites, as SuiteA.*:SuiteB.*, whose cases share what takes long to make: one process for them all, not in
# SLOW_S, which is then 0 by default: there are no others.
# SERIAL: no other test runs at the same time, for tests that watch processes on the wall clock.
include(GoogleTest)
function(fidservo_test name)
  cmake_parse_arguments(ARG "SERIAL" "QUICK_S;SLOW_S;SLOW_TOGETHER" "SOURCES;USES" ${ARGN})
  if(NOT ARG_QUICK_S)
    set(ARG_QUICK_S 1)
  endif()
  set(slow_cases "Slow*")
  if(ARG_SLOW_TOGETHER)
    set(slow_cases "Slow*-${ARG_SLOW_TOGETHER}")
  elseif(NOT ARG_SLOW_S)
    set(ARG_SLOW_S 15)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  fidservo_in_a_test_program(${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE fidservo_test_options ${ARG_USES} GTest::gtest_main GTest::gmock)
  fidservo_compiled_with(${name} tests 1)
  target_compile_definitions(${name} PRIVATE
    FIDSERVO_ASSETS_DIR="${CMAKE_SOURCE_DIR}/assets"
    FIDSERVO_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    FIDSERVO_DATA_DIR="${FIDSERVO_DATA_DIR}")
  fidservo_shards(${name} quick "-Slow*" ${ARG_QUICK_S} 6 ${ARG_SERIAL})
  foreach(source ${ARG_SOURCES})
    file(STRINGS ${source} slow_suites REGEX "^(TEST|TEST_F|TEST_P|INSTANTIATE_TEST_SUITE_P)\\(Slow|^class Slow" LIMIT_COUNT 1)
    if(slow_suites AND ARG_SLOW_S)
      fidservo_shards(${name} slow ${slow_cases} ${ARG_SLOW_S} 30 ${ARG_SERIAL})
      break()
    endif()
  endforeach()
  if(ARG_SLOW_TOGETHER)
    add_test(NAME ${name}.slow.together COMMAND ${name} --gtest_filter=${ARG_SLOW_TOGETHER})
    set_tests_properties(${name}.slow.together PROPERTIES LABELS slow RUN_SERIAL ${ARG_SERIAL} TIMEOUT 1500 COST 60
      ENVIRONMENT ${fidservo_test_environment})
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS case RUN_SERIAL ${ARG_SERIAL} TIMEOUT 1500 ENVIRONMENT ${fidservo_test_environment})
endfunction()

# Data made by other people, kept out of the repository. Tests that use it skip where it is absent.
set(FIDSERVO_DATA_DIR "${CMAKE_SOURCE_DIR}/../shared/data" CACHE PATH "Folder of the shared data")
cmake_path(NORMAL_PATH FIDSERVO_DATA_DIR)
