# Installs the build to a fresh prefix, builds the consumer beside it against that prefix, and runs both.
set(work ${BUILD_DIR}/install_and_consume)
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${prefix})
run(${prefix}/${BINDIR}/arcslip --version)
if(NOT IS_DIRECTORY ${prefix}/share/arcslip/plots)
  message(FATAL_ERROR "share/arcslip/plots was not installed")
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${work}/bin)
run(${CMAKE_COMMAND} --build ${work}/build --config ${CONFIG})
run(${work}/bin/consumer)
