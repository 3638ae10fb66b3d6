# Builds and runs one of the consumer projects from nothing, as its user would.
file(REMOVE_RECURSE ${SCRATCH})
set(configure -S ${SOURCE}/examples/${WAY} -B ${SCRATCH}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
if(WAY STREQUAL "find_package")
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix --component core
    COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
  list(APPEND configure -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
else()
  list(APPEND configure -DSURFGRAD_SOURCE_DIR=${SOURCE})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} ${configure} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${SCRATCH}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SCRATCH}/build/consumer COMMAND_ERROR_IS_FATAL ANY)
