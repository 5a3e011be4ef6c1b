# The program that README shows is samples/hello_clgi.cpp, word for word, and short.
#
#   cmake -DSOURCE_DIR=... -P CheckReadme.cmake

cmake_minimum_required(VERSION 3.22)
file(READ "${SOURCE_DIR}/README.md" readme)
file(READ "${SOURCE_DIR}/samples/hello_clgi.cpp" sample)
string(FIND "${readme}" "```cpp\n${sample}```\n" found)
if(found EQUAL -1)
    message(FATAL_ERROR "readme: README.md does not show samples/hello_clgi.cpp as it is")
endif()
string(REGEX REPLACE "[^\n]" "" breaks "${sample}")
string(LENGTH "${breaks}" lines)
if(lines GREATER 60)
    message(FATAL_ERROR "readme: samples/hello_clgi.cpp has ${lines} lines, 60 at most")
endif()
message(STATUS "readme: shows samples/hello_clgi.cpp, ${lines} lines")
