# The examples of examples/plugins, copied away and built against the installation, by each compiler there is; then each
# runs its scene, which checks itself.
set(prefix ${PROJECT_BINARY_DIR}/tests/prefix)
set(outside ${PROJECT_BINARY_DIR}/tests/outside)
add_test(NAME "sdk: install" COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${prefix})
set_tests_properties("sdk: install" PROPERTIES FIXTURES_SETUP scree_prefix)

find_program(SCREE_GXX NAMES g++)
find_program(SCREE_CLANGXX NAMES clang++)
foreach(compiler GXX CLANGXX)
  if(NOT SCREE_${compiler})
    continue()
  endif()
  get_filename_component(name ${SCREE_${compiler}} NAME)
  set(folder ${outside}/${name})
  add_test(NAME "sdk: ${name} builds the examples against the installation"
           COMMAND ${CMAKE_COMMAND} -DPREFIX=${prefix} -DFOLDER=${folder} -DCOMPILER=${SCREE_${compiler}}
                   -DLAUNCHER=${SCREE_CCACHE} -P ${CMAKE_CURRENT_LIST_DIR}/build_examples.cmake)
  set_tests_properties("sdk: ${name} builds the examples against the installation" PROPERTIES
                       FIXTURES_REQUIRED scree_prefix FIXTURES_SETUP scree_examples_${name})
  foreach(example rolling sticky ellipse torus air piston xyz)
    add_test(NAME "sdk: ${example} built by ${name} measures what it says"
             COMMAND ${prefix}/bin/scree run ${folder}/${example}/scene.yaml --plugins ${folder}/build/plugins
                     --restart -j 1 -o ${folder}/out/${example})
    set_tests_properties("sdk: ${example} built by ${name} measures what it says" PROPERTIES
                         FIXTURES_REQUIRED "scree_prefix;scree_examples_${name}" FIXTURES_SETUP scree_run_${example}_${name})
  endforeach()
  add_test(NAME "sdk: piston built by ${name} finds its wall after an edit"
           COMMAND ${prefix}/bin/scree run ${CMAKE_CURRENT_LIST_DIR}/piston_after_edit.yaml --plugins ${folder}/build/plugins
                   --restart -j 1 -o ${folder}/out/piston_after_edit)
  set_tests_properties("sdk: piston built by ${name} finds its wall after an edit" PROPERTIES
                       FIXTURES_REQUIRED "scree_prefix;scree_examples_${name}")
  add_test(NAME "sdk: piston built by ${name} resumes bit for bit"
           COMMAND ${CMAKE_COMMAND} -DSCREE=${prefix}/bin/scree -DSCENE=${folder}/piston/scene.yaml
                   -DPLUGINS=${folder}/build/plugins -DFOLDER=${folder}/out -P ${CMAKE_CURRENT_LIST_DIR}/check_resume.cmake)
  set_tests_properties("sdk: piston built by ${name} resumes bit for bit" PROPERTIES
                       FIXTURES_REQUIRED "scree_prefix;scree_examples_${name}")
  add_test(NAME "sdk: frames of xyz built by ${name} read back"
           COMMAND ${CMAKE_COMMAND} -DFRAMES=${folder}/out/xyz/frames -P ${CMAKE_CURRENT_LIST_DIR}/check_frames.cmake)
  set_tests_properties("sdk: frames of xyz built by ${name} read back" PROPERTIES
                       FIXTURES_REQUIRED "scree_prefix;scree_examples_${name};scree_run_xyz_${name}")
endforeach()
