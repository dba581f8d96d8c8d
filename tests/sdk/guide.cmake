# The first chapter of the author's guide as it is written, and each header that an author includes alone.
add_test(NAME "sdk: the first law of the guide is written, built and run"
         COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/run_guide.sh ${PROJECT_SOURCE_DIR}/docs/plugins.md ${prefix}
                 ${PROJECT_BINARY_DIR}/tests/guide)
set_tests_properties("sdk: the first law of the guide is written, built and run" PROPERTIES
                     FIXTURES_REQUIRED scree_prefix ENVIRONMENT "SCREE_CCACHE=${SCREE_CCACHE}")

set(alone "-std=c++20 -fopenmp-simd -fsyntax-only -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror")
foreach(compiler GXX CLANGXX)
  if(SCREE_${compiler})
    get_filename_component(name ${SCREE_${compiler}} NAME)
    add_test(NAME "sdk: ${name} compiles each public header alone" COMMAND sh -ec
             "for header in abi.h contact_model.hpp wall.hpp generator.hpp process.hpp writer.hpp properties.hpp math.hpp; do echo \"#include <scree/$header>\" | ${SCREE_${compiler}} ${alone} -I${prefix}/include -x c++ -; done")
    set_tests_properties("sdk: ${name} compiles each public header alone" PROPERTIES FIXTURES_REQUIRED scree_prefix)
  endif()
endforeach()
add_test(NAME "sdk: abi.h is plain C" COMMAND sh -ec
         "echo '#include <scree/abi.h>' | ${CMAKE_C_COMPILER} -std=c99 -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -I${prefix}/include -x c -")
set_tests_properties("sdk: abi.h is plain C" PROPERTIES FIXTURES_REQUIRED scree_prefix)
