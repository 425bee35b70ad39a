# Rooms as targets, with warnings and sanitizers from one place.

add_library(brdfit_warnings INTERFACE)
target_compile_options(brdfit_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(BRDFIT_WERROR)
  target_compile_options(brdfit_warnings INTERFACE -Werror)
endif()
add_library(brdfit_flags INTERFACE)
target_link_libraries(brdfit_flags INTERFACE brdfit_warnings)
if(BRDFIT_SANITIZE)
  # Under the sanitizers g++ 12 takes members of std::regex for uninitialised.
  target_compile_options(brdfit_warnings INTERFACE -Wno-maybe-uninitialized)
  target_compile_options(brdfit_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(brdfit_flags INTERFACE -fsanitize=address,undefined)
endif()

# brdfit_add_room(NAME SOURCES ... PUBLIC libraries ... PRIVATE libraries ...): the library brdfit_NAME.
function(brdfit_add_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(brdfit_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(brdfit_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(brdfit_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE brdfit_flags ${ROOM_PRIVATE})
endfunction()
