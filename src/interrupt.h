/// Ctrl-C and termination: the handler only notes the signal; the run ends between two steps, so that its files are complete.
#pragma once

namespace musclesim::command_line {

/// Installs handlers for SIGINT and SIGTERM. A second signal ends the process at once.
void watchInterrupts();
/// Restores the default: from now on a signal ends the process at once. For commands that write each file in one piece.
void endAtInterrupts();
/// The number of the signal that arrived, 0 if none did.
int interruptSignal();

}  // namespace musclesim::command_line
