# SPDX-License-Identifier: GPL-3.0-or-later
# What is installed for those who build on the libraries: find_package(fidservo CONFIG) gives them a target a room,
# fidservo::core and its like. Two components: `program` is what a user needs, `development` what a programmer needs besides.

set(FIDSERVO_HEADER_DIR ${CMAKE_INSTALL_INCLUDEDIR}/fidservo)
# Debian's packages of what fidservoConfig.cmake looks for.
set(FIDSERVO_DEVELOPMENT_PACKAGES cmake g++ libapriltag-dev libceres-dev libcli11-dev libcomedi-dev libcpp-httplib-dev libeigen3-dev
  libexpected-dev libfmt-dev libmuparser-dev libnlopt-dev libopencv-dev libpng-dev libspdlog-dev libsqlite3-dev libssl-dev libturbojpeg0-dev libvisp-core-dev
  libvisp-vs-dev libyaml-cpp-dev nlohmann-json3-dev pkgconf)
set(FIDSERVO_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/fidservo)

# fidservo_export(NAME [HEADERS a.h ...]): the target fidservo_NAME is installed as fidservo::NAME, and HEADERS, of the calling
# folder, are its interface. What these include comes with them.
function(fidservo_export name)
  cmake_parse_arguments(ARG "" "" "HEADERS" ${ARGN})
  set_target_properties(fidservo_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(TARGET fidservo_${name} APPEND PROPERTY INTERFACE_COMPILE_FEATURES $<INSTALL_INTERFACE:cxx_std_20>)
  install(TARGETS fidservo_${name} EXPORT fidservo_targets COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${FIDSERVO_HEADER_DIR})
  foreach(header ${ARG_HEADERS})
    cmake_path(ABSOLUTE_PATH header OUTPUT_VARIABLE file)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_property(GLOBAL APPEND PROPERTY FIDSERVO_INTERFACE ${file})
  endforeach()
endfunction()

# headers_needed(RESULT HEADER...): these headers and all of the house that they include, from the top of the repository.
function(headers_needed result)
  set(open ${ARGN})
  set(all)
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST all)
      continue()
    endif()
    list(APPEND all ${header})
    file(STRINGS ${CMAKE_SOURCE_DIR}/${header} includes REGEX "^#include \"")
    foreach(include ${includes})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${include}")
      list(APPEND open ${include})
    endforeach()
  endwhile()
  set(${result} ${all} PARENT_SCOPE)
endfunction()

# What is installed once all rooms are known.
function(fidservo_install_interface)
  get_property(interface GLOBAL PROPERTY FIDSERVO_INTERFACE)
  headers_needed(headers ${interface})
  foreach(header ${headers})
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${CMAKE_SOURCE_DIR}/${header} DESTINATION ${FIDSERVO_HEADER_DIR}/${folder} COMPONENT development)
  endforeach()
  list(TRANSFORM interface PREPEND ${CMAKE_SOURCE_DIR}/ OUTPUT_VARIABLE interface_files)
  list(JOIN interface_files " " interface_files)
  configure_file(${CMAKE_SOURCE_DIR}/cmake/Doxyfile.in ${CMAKE_BINARY_DIR}/interface/Doxyfile @ONLY)
  list(TRANSFORM interface REPLACE ".+" "#include \"\\0\"" OUTPUT_VARIABLE includes)
  list(JOIN includes "\n" includes)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/interface/all_headers.cpp CONTENT "@includes@\n" @ONLY)

  include(CMakePackageConfigHelpers)
  configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/fidservoConfig.cmake.in ${CMAKE_BINARY_DIR}/fidservoConfig.cmake
    INSTALL_DESTINATION ${FIDSERVO_CONFIG_DIR} PATH_VARS CMAKE_INSTALL_DATADIR)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/fidservoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/fidservoConfig.cmake ${CMAKE_BINARY_DIR}/fidservoConfigVersion.cmake
    DESTINATION ${FIDSERVO_CONFIG_DIR} COMPONENT development)
  install(EXPORT fidservo_targets FILE fidservoTargets.cmake NAMESPACE fidservo:: DESTINATION ${FIDSERVO_CONFIG_DIR} COMPONENT development)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development PATTERN "python" EXCLUDE)
endfunction()
