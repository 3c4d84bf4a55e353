# Unity builds: the compiler reads several sources at once, so that it reads the headers that they share only once. This halves the time
# of a build from nothing. After a change it compiles more than needed, and it hides missing includes: the presets for development and
# scripts/check.sh build without it.
option(MUSCLESIM_UNITY "Compile several sources at once; faster from nothing, slower after a change" OFF)

# musclesim_unity(TARGET SIZE): compiles up to SIZE sources of TARGET at once. The sources of a unit come from one folder.
function(musclesim_unity target size)
  if(NOT MUSCLESIM_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  get_target_property(base ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${base} NORMALIZE OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    cmake_path(GET name PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER ${folder} folder)
    math(EXPR count_${folder} "0${count_${folder}} + 1")
    math(EXPR unit "(${count_${folder}} - 1) / ${size}")
    set_source_files_properties(${path} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${folder}_${unit})
  endforeach()
endfunction()
