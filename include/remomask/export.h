#pragma once

/// Marks what libremomask.so exports; everything else in it is hidden. Exception classes need it
/// as well, or a program could not catch them by type. A static library exports nothing:
/// programs that link it define REMOMASK_STATIC, which find_package(remomask) and pkg-config
/// see to.
#if defined(REMOMASK_STATIC) || !defined(__GNUC__)
#define REMOMASK_API
#else
#define REMOMASK_API __attribute__((visibility("default")))
#endif
