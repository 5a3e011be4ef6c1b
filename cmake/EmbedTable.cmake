# Writes the kernels and what they include as a C++ table of string literals, each file once, a line
# of source a literal, so that no single literal comes near any compiler's limit.
#
#   cmake -DFILES="kernels/a/b.cl;include/clgi/shared/base.h" -DSOURCE_DIR=... -DOUTPUT=...
#         -P EmbedTable.cmake

cmake_minimum_required(VERSION 3.22)
set(text "// Generated from kernels/. Do not edit.\n#include \"core/opencl/embedded.hpp\"\n\n")
string(APPEND text "namespace clgi {\n\nconst EmbeddedFile embedded_files[] = {\n")
foreach(file IN LISTS FILES)
    file(READ "${SOURCE_DIR}/${file}" source)
    string(REPLACE "\\" "\\\\" source "${source}")
    string(REPLACE "\"" "\\\"" source "${source}")
    string(REPLACE "\n" "\\n\"\n     \"" source "${source}")
    string(APPEND text "    {\"${file}\",\n     \"${source}\"},\n")
endforeach()
list(LENGTH FILES count)
string(APPEND text "};\n\nconst unsigned embedded_file_count = ${count};\n\n}  // namespace clgi\n")
file(WRITE "${OUTPUT}" "${text}")
