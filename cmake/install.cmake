# Program, library, headers and CMake package: find_package(musclesim) gives the target musclesim::musclesim.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/musclesim)

target_compile_features(musclesim_core PUBLIC cxx_std_20)  # the headers need it
install(TARGETS musclesim)
install(TARGETS musclesim_core EXPORT musclesimTargets)
install(EXPORT musclesimTargets NAMESPACE musclesim:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/musclesim ${PROJECT_BINARY_DIR}/include/musclesim
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

configure_package_config_file(cmake/musclesimConfig.cmake.in ${PROJECT_BINARY_DIR}/musclesimConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/musclesimConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/musclesimConfig.cmake ${PROJECT_BINARY_DIR}/musclesimConfigVersion.cmake cmake/FindODE.cmake
        DESTINATION ${package_dir})
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
