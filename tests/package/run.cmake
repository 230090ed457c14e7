# The package as its users meet it: installed, moved elsewhere, found by a small project, and run without the source
# tree. Called by the test `package` with SOURCE, BUILD, SCRATCH, CONFIG, GENERATOR, COMPILER, FLAGS, and the folders
# below the prefix BINDIR, DATADIR, LIBDIR, MANDIR. MODULES are those of the program; MANUAL whether it has manual pages.
# PYTHON, where the package for Python was built: the interpreter, and PYTHON_DIR below the prefix.
set(prefix ${SCRATCH}/moved)
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed (${status}):\n${output}${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${SCRATCH}/installed)
file(RENAME ${SCRATCH}/installed ${prefix})

# Debug information names the sources by its nature.
if(NOT CONFIG MATCHES "Deb")
  execute_process(COMMAND grep -rlF -e ${SOURCE}/ -e ${BUILD}/ ${prefix} OUTPUT_VARIABLE tied RESULT_VARIABLE status)
  if(NOT status EQUAL 1)
    message(FATAL_ERROR "Installed files name the source or the build folder:\n${tied}")
  endif()
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/consumer -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer --config ${CONFIG})
run(${SCRATCH}/consumer/consumer ${prefix}/${DATADIR}/deflect/devices/haptic-6psu.yaml)
message(STATUS "${output}")

run(${prefix}/${BINDIR}/deflect devices)
if(NOT output MATCHES "haptic-6psu")
  message(FATAL_ERROR "The installed program does not know its devices:\n${output}")
endif()

file(GLOB_RECURSE documents RELATIVE ${prefix}/${DATADIR}/deflect ${prefix}/${DATADIR}/deflect/*.md)
if(NOT documents STREQUAL "measurements/README.md")
  message(FATAL_ERROR "Installed documents are '${documents}', not the measurements' alone")
endif()

run(${prefix}/${BINDIR}/deflect effects)
if(NOT output MATCHES "guide_root_compliance")
  message(FATAL_ERROR "The installed program does not know its effects:\n${output}")
endif()

# What a shell and `man` find of it below a prefix.
function(check_documents prefix)
  run(${prefix}/${BINDIR}/deflect completion bash)
  file(READ ${prefix}/${DATADIR}/bash-completion/completions/deflect completion)
  if(NOT completion STREQUAL output)
    message(FATAL_ERROR "The installed completion is not that of the program.")
  endif()
  if(MANUAL)
    run(${prefix}/${BINDIR}/deflect --help)
    string(REGEX MATCHALL "\n  [a-z]+ " commands "${output}")
    list(TRANSFORM commands STRIP)
    list(TRANSFORM commands PREPEND "-")
    foreach(page "" ${commands})
      run(gzip -dc ${prefix}/${MANDIR}/man1/deflect${page}.1.gz)
      if(NOT output MATCHES "\ndeflect${page} ..?- [A-Za-z]" OR NOT output MATCHES "SEE ALSO")
        message(FATAL_ERROR "deflect${page}.1 is no manual page:\n${output}")
      endif()
    endforeach()
    # Each option begins a paragraph of its own.
    run(gzip -dc ${prefix}/${MANDIR}/man1/deflect-solve.1.gz)
    string(REPLACE "\\" "" output "${output}")
    foreach(option help pose joints load geometry element-size json report out quiet verbose)
      if(NOT output MATCHES "TP\n[^\n]*--${option}")
        message(FATAL_ERROR "deflect-solve.1 does not explain --${option}:\n${output}")
      endif()
    endforeach()
  endif()
endfunction()
check_documents(${prefix})

# The package for Python solves a machine that it knows by its name, and finds the module with Gmsh.
function(check_python prefix)
  if(NOT PYTHON)
    return()
  endif()
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/${PYTHON_DIR} PYTHONDONTWRITEBYTECODE=1 ${PYTHON} -c
      "import deflect\nm = deflect.load('haptic-6psu')\nm.export('${SCRATCH}/python.msh')\nprint(deflect.__file__, m.solve([0, 0, 200], [50, 0, 0]).report)")
  if(NOT output MATCHES "^${prefix}/${PYTHON_DIR}" OR NOT output MATCHES "displacement")
    message(FATAL_ERROR "The installed package for Python does not solve:\n${output}")
  endif()
endfunction()
check_python(${prefix})

# As a Debian package: only the program and what belongs to it, with all that it links with as dependencies.
find_program(SHLIBDEPS dpkg-shlibdeps)
find_program(FILE_TYPE file)
if(NOT SHLIBDEPS OR NOT FILE_TYPE)
  message(STATUS "No .deb was made: dpkg-dev and file are not both installed")
  return()
endif()
run(${CMAKE_CPACK} -G DEB -C ${CONFIG} --config ${BUILD}/CPackConfig.cmake -B ${SCRATCH}/deb)
file(GLOB deb ${SCRATCH}/deb/*.deb)
list(LENGTH deb number)
if(NOT number EQUAL 1 OR NOT deb MATCHES "/deflect_[0-9.]+_[a-z0-9]+\\.deb$")
  message(FATAL_ERROR "cpack made '${deb}', not one package deflect_VERSION_ARCHITECTURE.deb")
endif()

run(dpkg-deb --field ${deb})
foreach(field "Package: deflect" "Section: science" "Priority: optional" "Maintainer: [^\n]+ <[^\n]+>" "Depends: [^\n]*libc6"
              "Depends: [^\n]*libcholmod" "Depends: [^\n]*libgmsh" "Depends: [^\n]*libyaml-cpp" "Recommends: gnuplot")
  if(NOT "\n${output}" MATCHES "\n${field}")
    message(FATAL_ERROR "The package has no '${field}':\n${output}")
  endif()
endforeach()

run(dpkg-deb --extract ${deb} ${SCRATCH}/root)
run(${SCRATCH}/root/usr/bin/deflect validate haptic-6psu)
check_documents(${SCRATCH}/root/usr)
check_python(${SCRATCH}/root/usr)
foreach(module ${MODULES})
  if(NOT EXISTS ${SCRATCH}/root/usr/${LIBDIR}/deflect/${module}.so)
    message(FATAL_ERROR "The package has no module ${module}")
  endif()
endforeach()
file(GLOB_RECURSE development ${SCRATCH}/root/*.h ${SCRATCH}/root/*.a ${SCRATCH}/root/*.cmake)
if(development)
  message(FATAL_ERROR "The package is for users of the program; these are not for them:\n${development}")
endif()
# Gmsh is loaded as a module: from where the package has put it.
run(${SCRATCH}/root/usr/bin/deflect solve haptic-6psu --pose 0,0,200 --load 50,0,0 --element-size "100 mm")
