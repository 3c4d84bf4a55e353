# Run with cmake -P; see CMakeLists.txt for the variables.
function(run)
  list(JOIN ARGN " " command)
  message("-- ${command}")
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "ended with ${status}: ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE "${work}")
run("${CMAKE_COMMAND}" --install "${build}" --prefix "${work}/prefix" --config "${configuration}")

execute_process(COMMAND "${work}/prefix/bin/musclesim" --version OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
if(NOT printed STREQUAL "musclesim ${version}\n")
  message(FATAL_ERROR "the installed program prints \"${printed}\" instead of its version ${version}")
endif()

foreach(project consumer examples)
  if(project STREQUAL "consumer")
    set(source "${CMAKE_CURRENT_LIST_DIR}/consumer")
  else()
    set(source "${examples}")
  endif()
  run("${CMAKE_COMMAND}" -S "${source}" -B "${work}/${project}" -G "${generator}" "-DCMAKE_PREFIX_PATH=${work}/prefix"
      "-DCMAKE_CXX_COMPILER=${compiler}" -DCMAKE_BUILD_TYPE=RelWithDebInfo)
  run("${CMAKE_COMMAND}" --build "${work}/${project}")
  run("${CMAKE_CTEST_COMMAND}" --test-dir "${work}/${project}" --output-on-failure)
endforeach()
