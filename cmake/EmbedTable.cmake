# Writes flattened kernels as a C++ table of string literals, a line of source a literal, so that
# no single literal comes near any compiler's limit.
#
#   cmake -DKERNELS="a/b;c/d" -DFOLDER=... -DOUTPUT=... -P EmbedTable.cmake

cmake_minimum_required(VERSION 3.22)
set(text "// Generated from kernels/. Do not edit.\n#include \"core/opencl/embedded.hpp\"\n\n")
string(APPEND text "namespace clgi {\n\nconst EmbeddedKernel embedded_kernels[] = {\n")
foreach(kernel IN LISTS KERNELS)
    file(READ "${FOLDER}/${kernel}.cl" source)
    string(REPLACE "\\" "\\\\" source "${source}")
    string(REPLACE "\"" "\\\"" source "${source}")
    string(REPLACE "\n" "\\n\"\n     \"" source "${source}")
    string(APPEND text "    {\"${kernel}\",\n     \"${source}\"},\n")
endforeach()
list(LENGTH KERNELS count)
string(APPEND text "};\n\nconst unsigned embedded_kernel_count = ${count};\n\n}  // namespace clgi\n")
file(WRITE "${OUTPUT}" "${text}")
