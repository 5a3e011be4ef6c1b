# Every test that docs/stability.md names as `file_test.Case` exists.
#
#   cmake -DSOURCE_DIR=... -P CheckStability.cmake

cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/StabilityCases.cmake")
clgi_stability_cases("${SOURCE_DIR}")
if(CLGI_STABILITY_COUNT LESS 100)
    string(APPEND CLGI_STABILITY_FAULTS "\n  only ${CLGI_STABILITY_COUNT} tests are named")
endif()
if(CLGI_STABILITY_FAULTS)
    message(FATAL_ERROR "docs/stability.md names tests that are not there:${CLGI_STABILITY_FAULTS}")
endif()
message(STATUS "docs/stability.md names ${CLGI_STABILITY_COUNT} tests")
