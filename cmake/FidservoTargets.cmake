# How every room of the house is compiled. Warnings are errors.

set(FIDSERVO_SANITIZE "" CACHE STRING "Sanitizers for everything: address,undefined or thread")

add_library(fidservo_compile_options INTERFACE)
target_include_directories(fidservo_compile_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(fidservo_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  -fno-math-errno)
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

# fidservo_library(NAME SOURCES a.cpp ... USES targets...): the one library target of a room.
function(fidservo_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PRIVATELY" ${ARGN})
  add_library(fidservo_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(fidservo_${name} PUBLIC fidservo_compile_options ${ARG_USES} PRIVATE ${ARG_PRIVATELY})
  if(FIDSERVO_PRECOMPILED)
    target_precompile_headers(fidservo_${name} REUSE_FROM fidservo_precompiled)
  endif()
endfunction()

# Under a sanitizer the libraries' start takes longer than most tests: there a few processes run all quick tests of a
# program. Those of a serial program stay in one.
function(fidservo_shards name serial)
  set(shards 4)
  if(serial)
    set(shards 1)
  endif()
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${name}.${shard} COMMAND ${name} --gtest_filter=-Slow*)
    set_tests_properties(${name}.${shard} PROPERTIES LABELS quick RUN_SERIAL "${serial}" TIMEOUT 1500
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()

# Notes sources that are in some test program; tests/CMakeLists.txt looks for those that are in none.
function(fidservo_in_a_test_program)
  foreach(source ${ARGN})
    cmake_path(ABSOLUTE_PATH source)
    set_property(GLOBAL APPEND PROPERTY FIDSERVO_TEST_SOURCES ${source})
  endforeach()
endfunction()

# The allocator keeps what a diagnosis gives back, as in the program: the same bounds as in src/main.cpp.
set(fidservo_test_environment "GLIBC_TUNABLES=glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=268435456")

# fidservo_test(NAME [SERIAL] SOURCES a.cpp ... USES targets...): one GoogleTest program.
# Tests whose name begins with Slow get the label slow, the others quick. SERIAL: no other test runs at the same
# time, for tests that watch processes on the wall clock.
include(GoogleTest)
function(fidservo_test name)
  cmake_parse_arguments(ARG "SERIAL" "" "SOURCES;USES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  fidservo_in_a_test_program(${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE fidservo_test_options ${ARG_USES} GTest::gtest_main GTest::gmock)
  target_precompile_headers(${name} REUSE_FROM fidservo_precompiled)
  target_compile_definitions(${name} PRIVATE
    FIDSERVO_ASSETS_DIR="${CMAKE_SOURCE_DIR}/assets"
    FIDSERVO_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    FIDSERVO_DATA_DIR="${FIDSERVO_DATA_DIR}")
  if(FIDSERVO_SANITIZE)
    fidservo_shards(${name} "${ARG_SERIAL}")
  else()
    gtest_discover_tests(${name} TEST_FILTER "-Slow*" PROPERTIES LABELS quick RUN_SERIAL ${ARG_SERIAL} TIMEOUT 300 DISCOVERY_TIMEOUT 60)
  endif()
  gtest_discover_tests(${name} TEST_FILTER "Slow*" DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS slow RUN_SERIAL ${ARG_SERIAL} TIMEOUT 1500 ENVIRONMENT ${fidservo_test_environment})
endfunction()

# Data made by other people, kept out of the repository. Tests that use it skip where it is absent.
set(FIDSERVO_DATA_DIR "${CMAKE_SOURCE_DIR}/../shared/data" CACHE PATH "Folder of the shared data")
cmake_path(NORMAL_PATH FIDSERVO_DATA_DIR)
