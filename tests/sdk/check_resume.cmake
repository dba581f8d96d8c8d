# cmake -DSCREE= -DSCENE= -DPLUGINS= -DFOLDER= -P check_resume.cmake: the scene run through and run in two parts ends in the
# same state. A model process that forgot something would not.
function(run)
  execute_process(COMMAND ${SCREE} ${ARGN} --plugins ${PLUGINS} -j 1 --quiet RESULT_VARIABLE status OUTPUT_VARIABLE out
                  ERROR_VARIABLE out)
  if(NOT status EQUAL 0 AND NOT status EQUAL 7)  # 7: a run that is cut short does not meet its expectations yet
    message(FATAL_ERROR "scree ${ARGN} ends with ${status}:\n${out}")
  endif()
endfunction()
function(state_hash folder name)
  file(READ ${folder}/summary.json text)
  string(JSON hash GET "${text}" state_hash)
  string(JSON cycles GET "${text}" cycles)
  set(${name} "${hash} after ${cycles} cycles" PARENT_SCOPE)
endfunction()

run(run ${SCENE} --restart -o ${FOLDER}/through)
run(run ${SCENE} --restart -o ${FOLDER}/parts -n 2000)
state_hash(${FOLDER}/parts part)
run(resume ${FOLDER}/parts)
state_hash(${FOLDER}/through through)
state_hash(${FOLDER}/parts parts)
if(NOT parts STREQUAL through)
  message(FATAL_ERROR "run through: ${through}; in two parts: ${parts}")
endif()
if(part STREQUAL through)
  message(FATAL_ERROR "the first part is the whole run, so nothing was resumed")
endif()
