# Pictures and the window are built where their libraries are installed; a headless build needs none of them.
option(MUSCLESIM_PICTURES "Draw pictures and videos without a display" ON)

if(MUSCLESIM_PICTURES)
  find_package(PNG QUIET)
  find_path(OSMESA_INCLUDE_DIR GL/osmesa.h)
  if(PNG_FOUND AND OSMESA_INCLUDE_DIR)
    add_subdirectory(simulation/scene)
  else()
    message(STATUS "No pictures: libpng-dev or libosmesa6-dev is not installed")
  endif()
endif()
