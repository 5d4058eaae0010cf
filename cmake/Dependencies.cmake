# Finds every library that the project links. All come from system packages
# (tools/install-packages.sh).
find_package(PkgConfig REQUIRED)
find_package(embree 3 QUIET)
if(NOT embree_FOUND)
  find_package(embree 4 REQUIRED)
endif()
find_package(TBB REQUIRED)
find_package(Imath REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(ZLIB REQUIRED)
find_package(EXPAT REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(GIF REQUIRED)
# WebP and sounds, for the program that decodes them
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)
find_package(Freetype REQUIRED)
pkg_check_modules(HARFBUZZ REQUIRED IMPORTED_TARGET harfbuzz)
pkg_check_modules(FONTCONFIG REQUIRED IMPORTED_TARGET fontconfig)
pkg_check_modules(GLU REQUIRED IMPORTED_TARGET glu)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(ZMQ REQUIRED IMPORTED_TARGET libzmq)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  set(OPENRT_ON_ARM ON)
  # Vectors of SVE have no operators, which our lanes use: ARM computes with NEON
  # (docs/decisions/0074).
  set_property(TARGET PkgConfig::HWY APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS
               "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
  # Highway compiles NEON with the cryptography extension, and GCC 12 does not give the pragma of a
  # target to constructors that it makes itself. It then refuses to inline what they call. With the
  # option both agree; no code uses the extension.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_CXX_FLAGS MATCHES "-march=|-mcpu=")
    set_property(TARGET PkgConfig::HWY APPEND PROPERTY INTERFACE_COMPILE_OPTIONS -march=armv8-a+crypto)
  endif()
endif()
if(OPENRT_FILMS)
  # films; without them MovieTextures show a still picture
  pkg_check_modules(FFMPEG IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
endif()
# without it only resource limits restrict untrusted scripts and the decoder
pkg_check_modules(SECCOMP IMPORTED_TARGET libseccomp)
if(OPENRT_WINDOW)
  pkg_check_modules(SDL2 IMPORTED_TARGET sdl2) # without it vv opens no window
  pkg_check_modules(IMGUI IMPORTED_TARGET imgui) # without it the window has no editor
endif()
if(OPENRT_SERVER)
  pkg_check_modules(WEBSOCKETS IMPORTED_TARGET libwebsockets>=4.1) # without it vv serves no page
endif()
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_path(TOMLPLUSPLUS_INCLUDE toml++/toml.h REQUIRED)
find_package(nlohmann_json REQUIRED)
find_path(FAST_FLOAT_INCLUDE fast_float/fast_float.h REQUIRED)
find_path(FLATBUFFERS_INCLUDE flatbuffers/flatbuffers.h REQUIRED)
find_program(FLATC flatc REQUIRED)
