# remomask_flags(target): warnings, sanitizers, no path of the source tree in the result.
function(remomask_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
    -ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False alarms of GCC 12 on std::string concatenation (GCC bug 105329).
    target_compile_options(${target} PRIVATE -Wno-restrict)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
      # And of later ones on std::vector<bool>, as torch::autograd::Function uses it.
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
    endif()
  endif()
  if(REMOMASK_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(REMOMASK_SANITIZE)
    # Undefined behaviour is a failure as well, not a line in the log. The checks left out are made
    # at every use of a pointer and take 40 % of the compile time: AddressSanitizer stops at null
    # pointers and foreign memory by itself, and no code reads wide values through byte pointers.
    target_compile_options(${target} PUBLIC
      -fsanitize=address,undefined -fno-sanitize=null,object-size,vptr,alignment
      -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# remomask_room(name USES room ... LIBRARIES target ... [SOURCES generated.cpp ...])
# One static library a room, from all .cpp files of its folder. Unity builds, because
# the torch headers cost 15-20 s a unit: names at namespace scope must be unique
# within a room. cmake/library.cmake joins the rooms into libremomask.
function(remomask_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_library(remomask_${name} STATIC ${sources} ${ARG_SOURCES})
  # Only what the public headers mark leaves the shared library.
  set_target_properties(remomask_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden)
  set_property(TARGET remomask_${name} PROPERTY REMOMASK_LIBRARIES ${ARG_LIBRARIES})
  target_compile_features(remomask_${name} PUBLIC cxx_std_20)
  target_include_directories(remomask_${name} PUBLIC
    ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(remomask_${name} PUBLIC remomask_${used})
  endforeach()
  target_link_libraries(remomask_${name} PUBLIC ${ARG_LIBRARIES})
  remomask_flags(remomask_${name})
endfunction()
