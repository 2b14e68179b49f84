# Targets remomask::index, remomask::generator and the rooms below them, and
# remomask::startup, which programs link to pick the BLAS kernels at their start.
include(${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/remomaskTargets.cmake)
