# What README must agree with: the program that it shows is samples/hello_clgi.cpp, word for word,
# and short; its list of documentation has every page of docs/.
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
file(GLOB pages RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/docs/*.md")
string(FIND "${readme}" "\n## Documentation\n" index)
string(SUBSTRING "${readme}" ${index} -1 index)
foreach(page IN LISTS pages)
    string(FIND "${index}" "- [${page}](${page}): " found)
    if(found EQUAL -1)
        message(FATAL_ERROR "readme: the section Documentation of README.md does not list ${page}")
    endif()
endforeach()
message(STATUS "readme: shows samples/hello_clgi.cpp, ${lines} lines")
