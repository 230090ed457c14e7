# `cpack -G DEB` in the build folder: deflect_VERSION_ARCHITECTURE.deb with the program, its modules, data, manual pages
# and completion. What it links with becomes its dependencies (dpkg-shlibdeps).
set(CPACK_PACKAGE_NAME deflect)
set(CPACK_PACKAGE_VENDOR deflect)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "How far does the tool point of a robot, haptic device or other mechanism move under load?
deflect predicts it by a closed form and by a frame solver, compares both with measurements, and says which physical
effect a model lacks.")
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
if(NOT CPACK_DEBIAN_PACKAGE_MAINTAINER)
  set(CPACK_DEBIAN_PACKAGE_MAINTAINER "deflect <deflect@localhost>")
endif()
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# gnuplot draws the figures; with the reference BLAS large frames take fifteen times longer.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, fonts-dejavu-core, libopenblas0-pthread")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, openmpi-bin")
if(TARGET deflect_python)  # the package deflect, for Debian's Python
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", python3, python3-numpy, python3-matplotlib")
endif()
include(CPack)
