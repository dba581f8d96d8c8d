# cmake -DPREFIX= -DFOLDER= -DCOMPILER= [-DLAUNCHER=] -P build_examples.cmake: the installed examples, built in FOLDER with
# nothing of this tree in the way.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}:\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(COPY ${PREFIX}/share/scree/examples/plugins/ DESTINATION ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/out)
set(warnings "-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror")
if(COMPILER MATCHES "/g[+][+]$")
  string(APPEND warnings " -Wno-restrict")  # g++ 12 reports it wrongly on string concatenation
endif()
run(${CMAKE_COMMAND} -S ${FOLDER} -B ${FOLDER}/build -G Ninja -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_CXX_FLAGS=${warnings}
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
run(${CMAKE_COMMAND} --build ${FOLDER}/build)

# Every header folder that a compilation is given lies in the installation.
file(READ ${FOLDER}/build/compile_commands.json commands)
string(REGEX MATCHALL "-(I|isystem)[ ]*[^ \"]+" folders "${commands}")
if(NOT folders)
  message(FATAL_ERROR "no header folder in compile_commands.json")
endif()
foreach(folder ${folders})
  if(NOT folder MATCHES "${PREFIX}/include$")
    message(FATAL_ERROR "the examples are built with ${folder}")
  endif()
endforeach()
file(GLOB sources ${FOLDER}/*/*.cpp)
foreach(source ${sources})
  file(READ ${source} text)
  string(REGEX REPLACE "[^\n]" "" lines "${text}")
  string(LENGTH "${lines}" count)
  if(count GREATER 60)
    message(FATAL_ERROR "${source} has ${count} lines, an example has 60 at most")
  endif()
endforeach()
