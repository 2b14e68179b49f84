# libremomask: the objects of all rooms that a public header needs, in one library. The
# target remomask::remomask is the same inside the project and after find_package.
set(library_rooms ${REMOMASK_ROOMS})
list(REMOVE_ITEM library_rooms lab synthetic)  # they compare models and make test motions

set(objects "")
set(libraries "")
foreach(room IN LISTS library_rooms)
  list(APPEND objects $<TARGET_OBJECTS:remomask_${room}>)
  get_target_property(used remomask_${room} REMOMASK_LIBRARIES)
  if(used)
    list(APPEND libraries ${used})
  endif()
endforeach()
list(REMOVE_DUPLICATES libraries)

if(BUILD_SHARED_LIBS)
  add_library(remomask_library SHARED ${objects})
  target_link_libraries(remomask_library PRIVATE ${libraries})
  set(version_script ${PROJECT_SOURCE_DIR}/cmake/libremomask.map)
  target_link_options(remomask_library PRIVATE LINKER:--version-script=${version_script})
  if(NOT REMOMASK_SANITIZE)  # whose run time comes with the program
    target_link_options(remomask_library PRIVATE LINKER:--no-undefined)
  endif()
  set_target_properties(remomask_library PROPERTIES
    LINK_DEPENDS ${version_script}
    VERSION ${PROJECT_VERSION}
    # Before 1.0 every minor version may break the interface.
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
else()
  add_library(remomask_library STATIC ${objects})
  # By file name in the installed package: its user needs no CMake files but these.
  target_link_libraries(remomask_library PUBLIC ${libraries})
  target_compile_definitions(remomask_library INTERFACE REMOMASK_STATIC)
endif()
set_target_properties(remomask_library PROPERTIES
  LINKER_LANGUAGE CXX OUTPUT_NAME remomask EXPORT_NAME remomask)
target_compile_features(remomask_library INTERFACE cxx_std_20)
target_include_directories(remomask_library INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
remomask_flags(remomask_library)
add_library(remomask::remomask ALIAS remomask_library)
