# Formula for Homebrew: vv, openrt-worker, openrt-replay, the libraries and their headers. contrib/github/release.yml fills in url and
# sha256 of a release and attaches the result to it; `brew install --formula ./openrt.rb` installs that. The Python package is a wheel.
class Openrt < Formula
  desc "Ray-traced pictures of VRML, X3D and mesh files"
  homepage "https://openrt.invalid/"
  url "https://openrt.invalid/openrt-0.2.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "BSD-3-Clause"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "cppzmq" => :build
  depends_on "fast_float" => :build
  depends_on "flatbuffers" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "tomlplusplus" => :build
  depends_on "duktape"
  depends_on "embree"
  depends_on "ffmpeg"
  depends_on "fmt"
  depends_on "fontconfig"
  depends_on "freetype"
  depends_on "giflib"
  depends_on "harfbuzz"
  depends_on "highway"
  depends_on "imath"
  depends_on "jpeg-turbo"
  depends_on "libpng"
  depends_on "libsndfile"
  depends_on "libwebsockets"
  depends_on "lz4"
  depends_on "mesa-glu"
  depends_on "openexr"
  depends_on "sdl2"
  depends_on "tbb"
  depends_on "webp"
  depends_on "xxhash"
  depends_on "zeromq"
  depends_on "zstd"
  uses_from_macos "expat"
  uses_from_macos "python" => :build
  uses_from_macos "zlib"

  on_linux do
    depends_on "libseccomp"
  end

  def install
    system "cmake", "-S", ".", "-B", "build/brew", "-G", "Ninja", "-DOPENRT_PYTHON=OFF", *std_cmake_args
    system "cmake", "--build", "build/brew"
    %w[libopenrt libxvrml dev vv].each do |part|
      system "cmake", "--install", "build/brew", "--component", part
    end
  end

  test do
    (testpath/"ball.wrl").write <<~WORLD
      #VRML V2.0 utf8
      Shape { appearance Appearance { material Material { } } geometry Sphere { } }
    WORLD
    system bin/"vv", "ball.wrl", "-o", "ball.png", "--size", "64x48", "--spp", "4", "--strict"
    assert_equal "\x89PNG".b, (testpath/"ball.png").binread(4)
  end
end
