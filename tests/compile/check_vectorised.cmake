# cmake -DCOMPILE=... -P check_vectorised.cmake: g++ must report at least LOOPS of the adapter's
# loops in each of the three widths of vectors.
separate_arguments(command UNIX_COMMAND "${COMPILE}")
execute_process(COMMAND ${command} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "did not compile:\n${err}")
endif()
foreach(bytes 16 32 64)
  string(REGEX MATCHALL "contact_batch.hpp:[0-9]+:[0-9]+: optimized: loop vectorized using ${bytes} byte vectors" hits "${err}")
  list(LENGTH hits count)
  if(count LESS LOOPS)
    message(FATAL_ERROR "${count} loops use vectors of ${bytes} bytes, ${LOOPS} should")
  endif()
endforeach()
