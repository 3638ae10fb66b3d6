# One static library a module. Dependencies point one way (see docs/architecture.md).

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

find_program(SURFGRAD_CCACHE ccache)
if(SURFGRAD_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SURFGRAD_CCACHE})
endif()

# Every target of this project compiles with these. Contraction would make results depend on
# whether the processor has fused multiply-add; sanitizers must see the whole program.
add_library(surfgrad_options INTERFACE)
target_compile_options(surfgrad_options INTERFACE
  -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${SURFGRAD_WARNINGS_AS_ERRORS}>:-Werror>)
if(SURFGRAD_SANITIZE)
  target_compile_options(surfgrad_options INTERFACE
    -fsanitize=${SURFGRAD_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # gcc cannot follow initialisation through its own instrumentation (seen in libstdc++'s std::regex).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(surfgrad_options INTERFACE -fsanitize=${SURFGRAD_SANITIZE})
endif()

# surfgrad_module(NAME SOURCES ... [DEPENDS modules...] [LIBRARIES packages...])
# DEPENDS and the headers they bring are public; LIBRARIES stay private to the module.
function(surfgrad_module NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  list(TRANSFORM ARG_DEPENDS PREPEND surfgrad_)
  if(ARG_SOURCES)
    add_library(surfgrad_${NAME} STATIC ${ARG_SOURCES})
    target_include_directories(surfgrad_${NAME} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(surfgrad_${NAME} PUBLIC ${ARG_DEPENDS} PRIVATE surfgrad_options ${ARG_LIBRARIES})
  else()
    add_library(surfgrad_${NAME} INTERFACE)
    target_include_directories(surfgrad_${NAME} INTERFACE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(surfgrad_${NAME} INTERFACE ${ARG_DEPENDS} ${ARG_LIBRARIES})
  endif()
endfunction()
