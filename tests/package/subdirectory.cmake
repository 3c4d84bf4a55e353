# Configures a project that adds the sources of musclesim with add_subdirectory, and compiles the project's own source. Ceres and CLI11 are
# hidden: if the library looked for them, the configuration would fail. Variables: musclesim (folder of its sources), work, generator,
# compiler. The library itself is not compiled again; package.installed_consumer links a program with nothing but the library.
file(REMOVE_RECURSE "${work}")
execute_process(COMMAND "${CMAKE_COMMAND}" --no-warn-unused-cli -S "${CMAKE_CURRENT_LIST_DIR}/subdirectory" -B "${work}" -G "${generator}"
                        "-DCMAKE_CXX_COMPILER=${compiler}" "-Dmusclesim=${musclesim}"
                        -DCMAKE_DISABLE_FIND_PACKAGE_Ceres=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${work}" --target consumer COMMAND_ERROR_IS_FATAL ANY)
