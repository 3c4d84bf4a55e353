/// The program `musclesim` as a function, for a main() that brings robots, controllers or effects of its own.
#pragma once

namespace musclesim {

/// Reads the command line, beginning with the program's name, runs one command and returns 0. What was registered before is known by its
/// name, like what musclesim brings:
///     int main(int count, char** arguments) {
///       musclesim::registerRobot<Mine>("mine", "my machine");
///       return musclesim::program(count, arguments);
///     }
/// After a failure it says on standard error why, and ends the process with the exit status of docs/reference/command_line.md: after a
/// fault of the physics engine nothing may be cleaned up. Ends in order on SIGINT and SIGTERM. Link with the target musclesim::program.
int program(int argument_count, char** arguments);

}  // namespace musclesim
