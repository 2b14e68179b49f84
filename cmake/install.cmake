# The program, its models, and what other projects link: find_package(remomask).

# remomask_headers(result header ...): these and all that they include.
function(remomask_headers result)
  set(waiting ${ARGN})
  set(found "")
  while(waiting)
    list(POP_FRONT waiting header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
      list(APPEND waiting ${included})
    endforeach()
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

install(TARGETS remomask RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES
    models/README.md models/base.safetensors models/procedural.sqlite
    models/procedural.sqlite.index
  DESTINATION ${CMAKE_INSTALL_DATADIR}/remomask)

remomask_headers(headers
  base/error.h
  base/progress.h
  db/database.h
  db/import.h
  generator/pipeline.h
  index/motion_search.h
  index/update_index.h
  motion/motion_file.h
  retriever/embed_database.h)
foreach(header IN LISTS headers)
  get_filename_component(room ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${REMOMASK_INCLUDE}/${room})
endforeach()

install(TARGETS
    remomask_base remomask_startup remomask_motion remomask_db remomask_nn remomask_text
    remomask_retriever remomask_index remomask_generator
  EXPORT remomaskTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  OBJECTS DESTINATION ${CMAKE_INSTALL_LIBDIR}/remomask)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/remomask)
install(EXPORT remomaskTargets NAMESPACE remomask:: DESTINATION ${package_folder})
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/remomaskConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
    cmake/remomaskConfig.cmake cmake/dependencies.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/remomaskConfigVersion.cmake
  DESTINATION ${package_folder})
