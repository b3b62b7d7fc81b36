# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages, by `./run package`: fidservo, what a user needs; libfidservo-dev, what a programmer needs besides;
# python3-fidservo, the Python module.

install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_SOURCE_DIR}/CITATION.cff ${CMAKE_SOURCE_DIR}/SECURITY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "self-check" EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/cmake/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fidservo COMPONENT program)
install(FILES ${CMAKE_SOURCE_DIR}/cmake/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libfidservo-dev COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The fidservo developers <fidservo@invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "visual inspection on a low-cost macro-micro positioning stage
Goes from site to site of a plate, servoes on the fiducials that a camera
sees, measures what is printed there and says what is within tolerance; on
the rig or on its simulation. Tells where rig and simulator disagree, and
which effect causes it.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME fidservo)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)

set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "libraries of fidservo, for programs of one's own
Static libraries, headers and CMake targets: fiducials measured with their
covariance, controllers, the simulated rig, calibration, identification,
diagnosis, recordings; eight example programs.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfidservo-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# The libraries link against no shared ones themselves; whoever links them needs all of these.
list(JOIN FIDSERVO_DEVELOPMENT_PACKAGES ", " development_packages)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "fidservo (= ${PROJECT_VERSION}), ${development_packages}")

if(TARGET fidservo_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "fidservo (= ${PROJECT_VERSION}), python3-numpy, python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_minor})")
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Python module of fidservo
Recordings as arrays, the simulated rig, fiducials measured in an image with
their covariance, and diagnoses of why a rig and its simulator disagree;
four example programs.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-fidservo)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
include(CPack)
