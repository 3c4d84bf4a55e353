# Components: `program` (program, manual page, completion, desktop file, documents), `development` (library, headers, CMake package,
# pkg-config file, examples) and, if the module is built, `python` (python/CMakeLists.txt). find_package(musclesim) gives the targets
# musclesim::musclesim and, if the program was built, musclesim::program.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/musclesim)

if(MUSCLESIM_PROGRAM)
  install(TARGETS musclesim COMPONENT program)
  install(TARGETS musclesim_own_program EXPORT musclesimTargets COMPONENT development)
  install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY docs/user docs/reference DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program)
  install(FILES packaging/musclesim.bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME musclesim
          COMPONENT program)
  install(FILES packaging/musclesim.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
  install(FILES packaging/musclesim.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)

  find_program(HELP2MAN help2man)
  if(HELP2MAN)
    set(manual_page ${PROJECT_BINARY_DIR}/musclesim.1)
    add_custom_command(OUTPUT ${manual_page} COMMAND ${PROJECT_SOURCE_DIR}/packaging/make_man_page.sh $<TARGET_FILE:musclesim> ${manual_page}
                       DEPENDS musclesim packaging/make_man_page.sh VERBATIM)
    add_custom_target(manual_page ALL DEPENDS ${manual_page})
    install(FILES ${manual_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  else()
    message(STATUS "No manual page: help2man is not installed")
  endif()
endif()

install(TARGETS musclesim_core EXPORT musclesimTargets COMPONENT development)
install(EXPORT musclesimTargets NAMESPACE musclesim:: DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/musclesim ${PROJECT_BINARY_DIR}/include/musclesim
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
configure_package_config_file(cmake/musclesimConfig.cmake.in ${PROJECT_BINARY_DIR}/musclesimConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/musclesimConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/musclesimConfig.cmake ${PROJECT_BINARY_DIR}/musclesimConfigVersion.cmake cmake/FindODE.cmake
        DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY docs/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development PATTERN "*.py" EXCLUDE)

# At installation, because the prefix may be chosen then.
install(CODE "
  set(PROJECT_VERSION ${PROJECT_VERSION})
  set(PROJECT_DESCRIPTION \"${PROJECT_DESCRIPTION}\")
  set(MUSCLESIM_MATIO_LINK \"${MUSCLESIM_MATIO_LINK}\")
  cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_PREFIX)
  cmake_path(APPEND CMAKE_INSTALL_PREFIX ${CMAKE_INSTALL_LIBDIR} OUTPUT_VARIABLE PC_LIBDIR)
  cmake_path(APPEND CMAKE_INSTALL_PREFIX ${CMAKE_INSTALL_INCLUDEDIR} OUTPUT_VARIABLE PC_INCLUDEDIR)
  configure_file(${PROJECT_SOURCE_DIR}/packaging/musclesim.pc.in ${PROJECT_BINARY_DIR}/musclesim.pc @ONLY)"
  COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/musclesim.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Debian packages: cpack -G DEB in the build folder.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME musclesim)
set(CPACK_PACKAGE_CONTACT "The musclesim developers <musclesim@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME musclesim)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libosmesa6")  # pictures without a display; looked for at run time
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libmusclesim-dev, gnuplot-nox, ffmpeg, bash-completion")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "simulator of robots driven by pneumatic artificial muscles
 Simulates robots, replays recordings through them, and says where and why recordings of a real machine differ from the model.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmusclesim-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libode-dev, libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libtomlplusplus-dev, libmuparser-dev, pkg-config")
if(MUSCLESIM_MATIO_LINK)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libmatio-dev")
endif()
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "library, headers and examples of musclesim
 For robots, controllers, effects and force laws of one's own.")
if(TARGET musclesim_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-musclesim)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module is compiled for one minor version of Python.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/python/postinst
                                                ${PROJECT_SOURCE_DIR}/packaging/python/prerm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib")  # the examples draw
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module of musclesim, a simulator of robots with pneumatic artificial muscles
 Simulations step by step with NumPy arrays, controllers and force laws in Python, recordings, replay, diagnosis, environments for learning.")
endif()
include(CPack)
