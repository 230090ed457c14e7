# `cmake --install`: the program with its data, manual pages and completion (component `program`); the libraries with
# their headers and a CMake package that may be moved (component `development`).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/deflect)

foreach(name base fields mechanism frame analytic meshes validation)
  if(TARGET deflect_${name})
    install(TARGETS deflect_${name} EXPORT deflectTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            COMPONENT development)
  endif()
endforeach()

if(TARGET deflect)
  install(TARGETS deflect RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)

  # The program itself says what stands in its manual pages and what can be completed.
  set(documents ${PROJECT_BINARY_DIR}/documents)
  find_program(HELP2MAN help2man)
  if(NOT HELP2MAN)
    message(STATUS "Without manual pages: help2man was not found")
  endif()
  add_custom_command(
    OUTPUT ${documents}/deflect.bash
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:deflect> -DHELP2MAN=${HELP2MAN} -DFOLDER=${documents}
            -P ${CMAKE_CURRENT_LIST_DIR}/documents.cmake
    DEPENDS deflect ${CMAKE_CURRENT_LIST_DIR}/documents.cmake
    COMMENT "Manual pages and completion, from the program's help"
    VERBATIM)
  add_custom_target(deflect_documents ALL DEPENDS ${documents}/deflect.bash)
  install(FILES ${documents}/deflect.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME deflect COMPONENT program)
  if(HELP2MAN)
    install(DIRECTORY ${documents}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  endif()
endif()

# Below deflect/ the headers keep their paths, because that is how they include each other.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/msa/*.h
     ${PROJECT_SOURCE_DIR}/analytic/*.h ${PROJECT_SOURCE_DIR}/meshes/*.h ${PROJECT_SOURCE_DIR}/validation/*.h)
list(FILTER headers EXCLUDE REGEX "^validation/(cli|python)/")
foreach(header ${headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/deflect/${folder}
          COMPONENT development)
endforeach()

foreach(folder devices effects/catalogue cases frames measurements)
  cmake_path(GET folder PARENT_PATH parent)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/validation/${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/deflect/${parent}
          COMPONENT program)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT program)

# Static libraries need at link time what they were compiled with; FindCHOLMOD goes along, SuiteSparse 5 has no package.
install(EXPORT deflectTargets NAMESPACE deflect:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/deflectConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/deflectConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/deflectConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/deflectConfig.cmake ${PROJECT_BINARY_DIR}/deflectConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindCHOLMOD.cmake DESTINATION ${package_dir} COMPONENT development)
