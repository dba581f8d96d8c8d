# The folders of `scree new`, built against the installation, and the schema of scenes.
set(prefix ${PROJECT_BINARY_DIR}/tests/prefix)
if(NOT TEST "sdk: install")
  add_test(NAME "sdk: install" COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${prefix})
  set_tests_properties("sdk: install" PROPERTIES FIXTURES_SETUP scree_prefix)
endif()

# A folder of each kind builds and passes its own test, at once.
function(scree_test_new kind name compiler)
  add_test(NAME "sdk: a new ${kind} with ${compiler}"
           COMMAND ${CMAKE_COMMAND} -DPREFIX=${prefix} -DKIND=${kind} -DNAME=${name} -DCOMPILER=${compiler}
                   -DFOLDER=${PROJECT_BINARY_DIR}/tests/new/${compiler} -DLAUNCHER=${SCREE_CCACHE} -P ${CMAKE_CURRENT_LIST_DIR}/check_new.cmake)
  set_tests_properties("sdk: a new ${kind} with ${compiler}" PROPERTIES FIXTURES_REQUIRED scree_prefix TIMEOUT 600)
endfunction()
foreach(kind contact_model wall generator process writer)
  # Names that the struct must not take from the SDK are names like any other.
  scree_test_new(${kind} ball g++)
endforeach()
scree_test_new(contact_model springs clang++)
scree_test_new(wall round_plate clang++)

file(GLOB_RECURSE scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.yaml ${PROJECT_SOURCE_DIR}/tests/scenes/*.yaml
     ${PROJECT_SOURCE_DIR}/tests/peers/scree/*.yaml)
# Scenes of plug-ins from outside need a schema that knows these; what scenes include is no scene.
list(FILTER scenes EXCLUDE REGEX "/examples/plugins/|/parts/")
add_test(NAME "sdk: the schema accepts every scene of the project"
         COMMAND ${SCREE_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/validate.py
                 ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/scree/scree.schema.json accepts ${scenes})
