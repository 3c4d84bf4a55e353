# The Python module, if what it needs is installed.
option(MUSCLESIM_PYTHON "Build the Python module if pybind11 and Python's headers are installed" ${PROJECT_IS_TOP_LEVEL})
if(NOT MUSCLESIM_PYTHON)
  return()
endif()
# Debian's Python, for which the package is made, unless -DPython3_EXECUTABLE names another.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 3.9 QUIET COMPONENTS Interpreter Development.Module)
set(PYTHON_EXECUTABLE ${Python3_EXECUTABLE})  # pybind11's name for it
find_package(pybind11 2.10 QUIET)
if(Python3_FOUND AND pybind11_FOUND)
  add_subdirectory(python)
else()
  message(STATUS "No Python module: pybind11-dev or python3-dev is not installed")
endif()
