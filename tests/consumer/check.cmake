# cmake -D BUILD=<build folder> -D SOURCE=<this folder> -D WORK=<scratch> -D CONFIG=<build type> -P check.cmake
#
# Installs the package to a folder of its own, then configures, builds and runs a project that knows nothing else.
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/build -D CMAKE_PREFIX_PATH=${WORK}/prefix
     -D CMAKE_BUILD_TYPE=${CONFIG})
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${WORK}/build/consumer)
file(REMOVE_RECURSE ${WORK})
