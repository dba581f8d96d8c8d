# A library built against the header of ABI 0.1 goes on running: in today's program, and in a loader built with a header
# that has grown at the end of its structs.
add_library(old_plugin MODULE saved/plugin_0_1.c)
target_compile_options(old_plugin PRIVATE -Wall -Wextra -Werror)
set(old_folder ${PROJECT_BINARY_DIR}/tests/old)
set_target_properties(old_plugin PROPERTIES PREFIX "" OUTPUT_NAME old SUFFIX .so C_VISIBILITY_PRESET hidden
                      LIBRARY_OUTPUT_DIRECTORY ${old_folder}/contact_model)
foreach(kind wall generator process writer)
  add_custom_command(TARGET old_plugin POST_BUILD COMMAND ${CMAKE_COMMAND} -E make_directory ${old_folder}/${kind}
    COMMAND ${CMAKE_COMMAND} -E copy ${old_folder}/contact_model/old.so ${old_folder}/${kind}/old.so)
endforeach()
add_test(NAME "sdk: plug-ins of ABI 0.1 run"
         COMMAND $<TARGET_FILE:scree> run ${CMAKE_CURRENT_SOURCE_DIR}/saved/scene.yaml --plugins ${old_folder} --restart -j 1
                 -o ${old_folder}/out)
set_tests_properties("sdk: plug-ins of ABI 0.1 run" PROPERTIES FIXTURES_SETUP scree_old_run)
add_test(NAME "sdk: a writer of ABI 0.1 wrote its lines"
         COMMAND ${CMAKE_COMMAND} -E compare_files ${old_folder}/out/lines.txt ${CMAKE_CURRENT_SOURCE_DIR}/saved/lines.txt)
set_tests_properties("sdk: a writer of ABI 0.1 wrote its lines" PROPERTIES FIXTURES_REQUIRED scree_old_run)

# The header of a later minor version: two more fields at the end of every struct that may grow.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/sdk/include/scree/abi.h)
file(READ ${PROJECT_SOURCE_DIR}/sdk/include/scree/abi.h future)
foreach(name property value random batch stiffness contact_model touches wall ball sink generator rows wall_view host step
             process frame files writer component plugin_header)
  string(REPLACE "\n} scree_${name};" "\n  double future[2];\n} scree_${name};" grown "${future}")
  if(grown STREQUAL future)
    message(FATAL_ERROR "abi.h has no struct scree_${name}")
  endif()
  set(future "${grown}")
endforeach()
string(REGEX REPLACE "#define SCREE_ABI_MINOR [0-9]+u" "#define SCREE_ABI_MINOR 999u" future "${future}")
set(future_folder ${PROJECT_BINARY_DIR}/tests/future)
file(CONFIGURE OUTPUT ${future_folder}/scree/abi.h CONTENT "${future}" @ONLY)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
file(GLOB loader CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/plugin/*.cpp)
add_executable(test_future_abi future_abi_test.cpp ${loader})
target_include_directories(test_future_abi BEFORE PRIVATE ${future_folder})
target_link_libraries(test_future_abi PRIVATE scree_test_main scree_base ${CMAKE_DL_LIBS} OpenSSL::Crypto)
target_compile_definitions(test_future_abi PRIVATE SCREE_PLUGIN_DIR="${SCREE_PLUGIN_DIR}")
add_dependencies(test_future_abi old_plugin)
catch_discover_tests(test_future_abi TEST_PREFIX "sdk: " PROPERTIES TIMEOUT 60)
