#pragma once

namespace remomask {

/// Calls `visit` with each setting that is recommended for this machine. Uses nothing but libc and
/// static memory, so that it may run before any constructor.
void visit_recommended_settings(void (*visit)(const char* name, const char* value, void* data),
                                void* data);

/// Logs once, in one line, which recommended settings were missing when the process started.
void log_missing_settings();

}  // namespace remomask
