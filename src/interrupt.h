/// Ctrl-C and termination: noted by the handler, acted upon between two steps, so that files are complete.
#pragma once

namespace musclesim::program {

/// Installs handlers for SIGINT and SIGTERM. A second signal ends the process at once.
void watchInterrupts();
/// From here on a signal ends the process at once: for commands whose files are each written in one go.
void endAtInterrupts();
/// The number of the signal that arrived, 0 if none did.
int interruptSignal();

}  // namespace musclesim::program
