# Writes what an installed program brings along beside its data, from what it says of itself: FOLDER/deflect.bash, the
# completion, and with HELP2MAN a manual page for it and one for each command, FOLDER/man1/*.1.gz. PROGRAM is the program.
cmake_policy(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  set(output "${output}" PARENT_SCOPE)
endfunction()

# page(name words... ): the manual page `name` of these words of a command line, with the help's own summary.
function(page name summary see)
  file(WRITE ${FOLDER}/include "[NAME]\n${name} \\- ${summary}\n\n[SEE ALSO]\n${see}\n")
  file(CREATE_LINK ${PROGRAM} ${FOLDER}/deflect SYMBOLIC)
  list(JOIN ARGN " " words)
  run(${CMAKE_COMMAND} -E env PATH=${FOLDER}:$ENV{PATH} ${HELP2MAN} --no-info --include=${FOLDER}/include
      --version-string=${version} --output=${FOLDER}/man1/${name}.1 ${words})
  run(gzip -9n ${FOLDER}/man1/${name}.1)
endfunction()

if(HELP2MAN)
  run(${PROGRAM} --version)
  string(STRIP "${output}" version)
  run(${PROGRAM} --help)
  string(REGEX REPLACE "^deflect: ([^\n]*)\n.*" "\\1" summary "${output}")
  string(REGEX REPLACE ".*\nSubcommands:\n" "" table "${output}")
  string(REGEX MATCHALL "(^|\n)  [a-z]+ " commands "${table}")
  list(TRANSFORM commands STRIP)
  list(TRANSFORM commands REPLACE "(.+)" "\\\\fBdeflect-\\1\\\\fP(1)" OUTPUT_VARIABLE pages)
  list(JOIN pages ", " pages)
  page(deflect "${summary}" "${pages}" deflect)
  foreach(command ${commands})
    # The summary is the beginning of the help: to its first colon, semicolon or full stop.
    run(${PROGRAM} ${command} --help)
    string(REGEX MATCH "^[^:;.\n]+" summary "${output}")
    page(deflect-${command} "${summary}" "\\fBdeflect\\fP(1)" deflect ${command})
  endforeach()
  file(REMOVE ${FOLDER}/deflect ${FOLDER}/include)
endif()

run(${PROGRAM} completion bash)
file(WRITE ${FOLDER}/deflect.bash "${output}")
