#pragma once

// The version of remomask. CMake reads it from here.
#define REMOMASK_VERSION_MAJOR 0
#define REMOMASK_VERSION_MINOR 2
#define REMOMASK_VERSION_PATCH 0
#define REMOMASK_VERSION "0.2.0"
