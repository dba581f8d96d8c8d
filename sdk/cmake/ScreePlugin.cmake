# scree_add_plugin(NAME KIND kind SOURCES file...): one plug-in library <kind>/<NAME>.so with the flags the SDK was measured with.
# kind: contact_model, wall, generator, process or writer.
function(scree_add_plugin name)
  cmake_parse_arguments(arg "" "KIND" "SOURCES;LIBRARIES" ${ARGN})
  set(target scree_plugin_${arg_KIND}_${name})
  add_library(${target} MODULE ${arg_SOURCES})
  if(TARGET scree_sdk)
    target_link_libraries(${target} PRIVATE scree_sdk)
  else()
    target_link_libraries(${target} PRIVATE scree::scree_sdk)
  endif()
  target_link_libraries(${target} PRIVATE ${arg_LIBRARIES})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE -O3 -fopenmp-simd -fno-math-errno -fno-trapping-math -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Without -fno-tree-pre every varying `a && b` in a law stops vectorisation (g++ 12). The ipa passes make copies of a
    # longer law that `flatten` can then no longer inline ("SSA form does not match"): three times slower. With modref and
    # pure-const g++ 12.2 leaves out calls of a function that only stores through a reference.
    target_compile_options(${target} PRIVATE -fno-tree-pre -fno-ipa-cp -fno-ipa-sra -fno-ipa-modref -fno-ipa-pure-const)
  else()
    # clang's `flatten` goes one level deep only.
    target_compile_options(${target} PRIVATE "SHELL:-mllvm -inline-threshold=100000")
  endif()
  # One exported symbol, whatever templates the author uses.
  set(map ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/scree_plugin.map)
  target_link_options(${target} PRIVATE "LINKER:--version-script=${map}")
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${name} SUFFIX ".so"
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "")
  if(SCREE_PLUGIN_DIR)
    set_target_properties(${target} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${SCREE_PLUGIN_DIR}/${arg_KIND})
    install(TARGETS ${target} LIBRARY DESTINATION ${SCREE_PLUGIN_DIR}/${arg_KIND})
  else()
    set_target_properties(${target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins/${arg_KIND})
  endif()
endfunction()
