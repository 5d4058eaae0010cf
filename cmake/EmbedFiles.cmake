# Writes a C++ file that holds the bytes of files: cmake -DOUTPUT=page.cpp "-DFILES=a;b" -P
# EmbedFiles.cmake. apps/vv/CMakeLists.txt runs it for the page of `vv serve`.
set(arrays "")
set(rows "")
set(number 0)
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char file${number}[] = {${bytes}};\n")
  string(APPEND rows "    {\"${name}\", {reinterpret_cast<const char*>(file${number}), sizeof file${number}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT}
     "// Written by cmake/EmbedFiles.cmake.
#include \"server/answer.h\"

namespace vv::server {

namespace {
${arrays}} // namespace

std::span<const PageFile> pageFiles() {
  static const PageFile files[] = {
${rows}  };
  return files;
}

} // namespace vv::server
")
