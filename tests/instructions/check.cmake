# cmake -DVALGRIND=valgrind -DPROGRAM=surfgrad -P check.cmake
#
# Instructions that composing the demo's five layers takes a pixel, in a bake of 64x64 on AVX2 packs: exact, on
# any machine, while others work. Valgrind stops at instructions of AVX-512.

# gcc 12 -O3: 950. A quarter more leaves room for other compilers; work that is done twice is more than that.
set(most_per_pixel 1188)
set(pixels 4096) # the torus fills its texture

if(NOT VALGRIND)
  message(STATUS "skipped: no valgrind")
  return()
endif()
if(DEFINED ENV{TMPDIR})
  set(folder $ENV{TMPDIR})
else()
  set(folder /tmp)
endif()
string(RANDOM name)
set(picture ${folder}/surfgrad_instructions_${name}.png)

set(ENV{SURFGRAD_ISA} avx2)
execute_process(
  COMMAND ${VALGRIND} --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no
          "--toggle-collect=surfgrad::engine::avx2::compose_tile*"
          ${PROGRAM} bake -o ${picture} --size 64 --threads 1
  RESULT_VARIABLE status OUTPUT_VARIABLE words ERROR_VARIABLE words)
file(REMOVE ${picture})
if(status EQUAL 3 AND words MATCHES "no avx2")
  message(STATUS "skipped: no AVX2")
  return()
endif()
if(NOT status EQUAL 0 OR NOT words MATCHES "Collected : ([0-9]+)")
  message(FATAL_ERROR "the program did not run under valgrind (${status}):\n${words}")
endif()
math(EXPR per_pixel "${CMAKE_MATCH_1} / ${pixels}")
message(STATUS "${per_pixel} instructions a pixel, at most ${most_per_pixel}")
if(per_pixel GREATER most_per_pixel)
  message(FATAL_ERROR "composing a pixel takes ${per_pixel} instructions, more than ${most_per_pixel}")
endif()
if(per_pixel LESS 100)
  message(FATAL_ERROR "that is not all of it: has compose_tile another name?")
endif()
