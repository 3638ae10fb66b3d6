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
    # Checks of every reference that is used, which double the time to compile: what they find also faults or is
    # found by AddressSanitizer, but for alignment, which no code here casts away.
    -fno-sanitize=null,alignment,object-size,vptr
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

# The instruction sets that the kernels are compiled for, and the compiler's flags for each. None under
# sanitizers: an instrumented kernel is not inlined, and functions that it leaves behind could be given by the
# linker to processors without the instruction set. The emulated lanes run the same code there.
if(SURFGRAD_SANITIZE)
  set(SURFGRAD_VECTOR_ISAS)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(SURFGRAD_VECTOR_ISAS sse4 avx2 avx512)
  set(SURFGRAD_FLAGS_sse4 -msse4.2 -mpclmul -maes)
  set(SURFGRAD_FLAGS_avx2 -mavx2 -mfma -mf16c -mbmi -mbmi2 -mpclmul -maes)
  set(SURFGRAD_FLAGS_avx512 ${SURFGRAD_FLAGS_avx2} -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx512cd)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(SURFGRAD_VECTOR_ISAS neon)
  set(SURFGRAD_FLAGS_neon -march=armv8-a+crypto) # Highway counts AES among it
endif()

# A pack handed to a function that is not inlined goes through memory: kernels are inlined whole.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(SURFGRAD_INLINE_FLAGS "SHELL:--param max-inline-insns-auto=1000" "SHELL:--param max-inline-insns-single=3000"
    "SHELL:--param inline-unit-growth=300" "SHELL:--param large-function-growth=2000"
    "SHELL:--param large-function-insns=20000" "SHELL:--param large-stack-frame-growth=10000"
    "SHELL:--param large-unit-insns=100000")
else()
  set(SURFGRAD_INLINE_FLAGS "SHELL:-mllvm -inline-threshold=3000")
endif()

# surfgrad_for_each_isa(NAME SOURCES ... [DEPENDS modules...]): adds sources to a module once for each
# instruction set. Those for one are optimised in every build type.
function(surfgrad_for_each_isa NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  list(TRANSFORM ARG_DEPENDS PREPEND surfgrad_)
  foreach(isa one_lane lanes ${SURFGRAD_VECTOR_ISAS})
    set(target surfgrad_${NAME}_${isa})
    add_library(${target} OBJECT ${ARG_SOURCES})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target} PRIVATE ${ARG_DEPENDS} surfgrad_options)
    target_compile_definitions(${target} PRIVATE SURFGRAD_ISA_NAMESPACE=${isa} HWY_COMPILE_ONLY_STATIC)
    if(isa IN_LIST SURFGRAD_VECTOR_ISAS)
      target_compile_options(${target} PRIVATE ${SURFGRAD_FLAGS_${isa}} -O3 ${SURFGRAD_INLINE_FLAGS})
    else()
      target_compile_definitions(${target} PRIVATE SURFGRAD_ISA_IS_PLAIN=1)
      # Emulated lanes are for debugging: inlined whole they take five times as long to compile.
      if(isa STREQUAL "one_lane" AND NOT SURFGRAD_SANITIZE)
        target_compile_options(${target} PRIVATE ${SURFGRAD_INLINE_FLAGS})
      endif()
    endif()
    target_sources(surfgrad_${NAME} PRIVATE $<TARGET_OBJECTS:${target}>)
  endforeach()
endfunction()
