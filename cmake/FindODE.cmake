# Finds the Open Dynamics Engine through its pkg-config file (Debian ships no CMake package) and defines ODE::ODE.
# The library must be built with double precision: musclesim's accuracy and reference trajectories depend on it.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_ODE QUIET ode)
endif()
find_path(ODE_INCLUDE_DIR ode/ode.h HINTS ${PC_ODE_INCLUDE_DIRS})
find_library(ODE_LIBRARY ode HINTS ${PC_ODE_LIBRARY_DIRS})
set(ODE_VERSION ${PC_ODE_VERSION})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ODE REQUIRED_VARS ODE_LIBRARY ODE_INCLUDE_DIR VERSION_VAR ODE_VERSION)

if(ODE_FOUND AND NOT TARGET ODE::ODE)
  add_library(ODE::ODE UNKNOWN IMPORTED)
  set_target_properties(ODE::ODE PROPERTIES IMPORTED_LOCATION "${ODE_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${ODE_INCLUDE_DIR}")
endif()
mark_as_advanced(ODE_INCLUDE_DIR ODE_LIBRARY)
