# The package as its users meet it: installed, moved elsewhere, found by a small project, and run without the source
# tree. Called by the test `package` with SOURCE, BUILD, SCRATCH, CONFIG, GENERATOR, COMPILER, FLAGS, and the folders
# below the prefix BINDIR, DATADIR.
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

run(${prefix}/${BINDIR}/deflect effects)
if(NOT output MATCHES "guide_root_compliance")
  message(FATAL_ERROR "The installed program does not know its effects:\n${output}")
endif()
