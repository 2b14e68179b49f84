# What a user gets: the program with models, pages and completion; the library with headers,
# CMake package and pkg-config file.
include(CMakePackageConfigHelpers)
set(data ${CMAKE_INSTALL_DATADIR}/remomask)
set(documents ${CMAKE_INSTALL_DATADIR}/doc/remomask)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/remomask)

# The library.
install(DIRECTORY include/remomask DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(TARGETS remomask_library EXPORT remomaskTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT remomaskTargets NAMESPACE remomask:: DESTINATION ${package})
configure_package_config_file(cmake/remomaskConfig.cmake.in
  ${PROJECT_BINARY_DIR}/remomaskConfig.cmake INSTALL_DESTINATION ${package}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/remomaskConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/remomaskConfig.cmake ${PROJECT_BINARY_DIR}/remomaskConfigVersion.cmake
  DESTINATION ${package})
if(NOT BUILD_SHARED_LIBS)
  install(FILES cmake/dependencies.cmake DESTINATION ${package})
  set(pc_static_flag " -DREMOMASK_STATIC")
  set(pc_static_libraries
    " -ltorch -ltorch_cpu -lc10 -lfaiss -llapack -lblas -lgomp -ldl -lpthread")
  set(pc_static_requires " sqlite3 fmt libxxhash libarchive tinygltf assimp cairo libutf8proc")
endif()
file(RELATIVE_PATH pc_prefix
  ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
configure_file(cmake/remomask.pc.in ${PROJECT_BINARY_DIR}/remomask.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/remomask.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The program. Its core is loaded only by the commands that need the networks.
install(TARGETS remomask RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET remomask-core)
  install(TARGETS remomask-core LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/remomask)
endif()
install(FILES
    models/base.safetensors models/evaluator.safetensors models/motions.sqlite
    models/motions.sqlite.index models/text.safetensors models/text.LICENSE models/README.md rig/skeleton_maps.json
  DESTINATION ${data})
install(DIRECTORY models/attributions DESTINATION ${data})

# Pages and completion, from the help texts of the program that was just built.
set(pages ${PROJECT_BINARY_DIR}/pages)
add_custom_command(
  OUTPUT ${pages}/remomask.1 ${pages}/remomask.bash
  COMMAND ${PROJECT_SOURCE_DIR}/tools/make_pages.sh $<TARGET_FILE:remomask> ${pages}
  DEPENDS remomask tools/make_pages.sh
  COMMENT "Manual page and completion"
  VERBATIM)
add_custom_target(remomask_pages ALL DEPENDS ${pages}/remomask.1 ${pages}/remomask.bash)
if(TARGET remomask-core)
  add_dependencies(remomask_pages remomask-core)
endif()
install(FILES ${pages}/remomask.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${pages}/remomask.bash
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME remomask)

install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${documents})
install(DIRECTORY docs examples DESTINATION ${documents})

include(cmake/package.cmake)
