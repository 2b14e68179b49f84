#pragma once

/// Marks what the shared library exports; everything else in it is hidden.
#if defined(REMOMASK_STATIC) || !defined(__GNUC__)
#define REMOMASK_API
#else
#define REMOMASK_API __attribute__((visibility("default")))
#endif
