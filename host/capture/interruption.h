#pragma once
// SIGINT and SIGTERM become an Error at the next safe point, so that destructors clean up.

namespace pmdsim {

// Installs the handlers; once, at the start.
void stop_on_signals();

// Throws Error (interrupted) where a signal has come.
void throw_if_interrupted();

} // namespace pmdsim
