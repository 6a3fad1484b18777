#pragma once

namespace arcslip {

/// From now on an interrupt (Ctrl-C, or a request to terminate) is noted; a second one ends the program at
/// once.
void catch_interrupts();

bool interrupted();

}  // namespace arcslip
