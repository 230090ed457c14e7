# `cmake --install`: the program, its data, the libraries with their headers, and a CMake package that may be moved.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/deflect)

foreach(name base mechanism frame analytic meshes validation)
  if(TARGET deflect_${name})
    install(TARGETS deflect_${name} EXPORT deflectTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endforeach()
if(TARGET deflect)
  install(TARGETS deflect RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

# Below deflect/ the headers keep their paths, because that is how they include each other.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/msa/*.h
     ${PROJECT_SOURCE_DIR}/analytic/*.h ${PROJECT_SOURCE_DIR}/meshes/*.h ${PROJECT_SOURCE_DIR}/validation/*.h)
list(FILTER headers EXCLUDE REGEX "^validation/cli/")
foreach(header ${headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/deflect/${folder})
endforeach()

foreach(folder devices effects cases)
  if(EXISTS ${PROJECT_SOURCE_DIR}/validation/${folder})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/validation/${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/deflect
            PATTERN "*.h" EXCLUDE PATTERN "*.cpp" EXCLUDE PATTERN "CMakeLists.txt" EXCLUDE)
  endif()
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Static libraries need at link time what they were compiled with; FindCHOLMOD goes along, SuiteSparse 5 has no package.
install(EXPORT deflectTargets NAMESPACE deflect:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/deflectConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/deflectConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/deflectConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/deflectConfig.cmake ${PROJECT_BINARY_DIR}/deflectConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindCHOLMOD.cmake DESTINATION ${package_dir})
