# remomask_flags(target): warnings, sanitizers.
function(remomask_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False alarms of GCC 12 on std::string concatenation (GCC bug 105329).
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(REMOMASK_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(REMOMASK_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=address,undefined -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# remomask_room(name SOURCES a.cpp ... USES room ... LIBRARIES target ...)
# One static library a room. Unity builds, because the torch headers cost
# 15-20 s a unit: names at namespace scope must be unique within a room.
function(remomask_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_library(remomask_${name} STATIC ${ARG_SOURCES})
  add_library(remomask::${name} ALIAS remomask_${name})
  set_target_properties(remomask_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(remomask_${name} PUBLIC cxx_std_20)
  target_include_directories(remomask_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${REMOMASK_INCLUDE}>)
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(remomask_${name} PUBLIC remomask_${used})
  endforeach()
  target_link_libraries(remomask_${name} PUBLIC ${ARG_LIBRARIES})
  remomask_flags(remomask_${name})
endfunction()
