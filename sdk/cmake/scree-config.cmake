include(${CMAKE_CURRENT_LIST_DIR}/scree-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/ScreePlugin.cmake)
