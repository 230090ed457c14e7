# The page of --report: esbuild bundles script and style with three.js and Chart.js as Debian packages them; the whole
# becomes one text in the program. Without them the program is built all the same and says so when asked for a page.
# Elsewhere than on Debian: -DESBUILD=…, -DTHREE_MODULE=…, -DTHREE_ORBIT=…, -DCHART_MODULE=… name the files.
find_program(ESBUILD esbuild)
find_file(THREE_MODULE three.module.js PATHS /usr/share/javascript/three /usr/share/nodejs/three/build NO_DEFAULT_PATH)
find_file(THREE_ORBIT OrbitControls.js PATHS /usr/share/javascript/three/examples/jsm/controls NO_DEFAULT_PATH)
find_file(CHART_MODULE chart.mjs PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist NO_DEFAULT_PATH)

set(template ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp)
file(GLOB parts CONFIGURE_DEPENDS page/*.js page/*.css page/*.html page/bundle.cmake)
if(ESBUILD AND THREE_MODULE AND THREE_ORBIT AND CHART_MODULE)
  set(bundled TRUE)
else()
  set(bundled FALSE)
  message(STATUS "Without --report: esbuild, libjs-three and libjs-chart.js were not all found")
endif()
add_custom_command(
  OUTPUT ${template}
  COMMAND ${CMAKE_COMMAND} -DBUNDLED=${bundled} -DESBUILD=${ESBUILD} -DTHREE=${THREE_MODULE} -DORBIT=${THREE_ORBIT}
          -DCHART=${CHART_MODULE} -DOUTPUT=${template} -P ${CMAKE_CURRENT_LIST_DIR}/bundle.cmake
  DEPENDS ${parts}
  COMMENT "Bundling the page of --report"
  VERBATIM)
target_sources(deflect_validation PRIVATE ${template})
