// alloc_failures.cpp: every allocation fails once. A small world with a texture, text, prototypes, an Inline, a Script, instances
// and a moving part is loaded, run and drawn; then again for each allocation that the project's libraries make on the way, with
// this one failing. What must hold each time: the process lives; an error is told by an exception, a message or rtGetError(), or
// the picture is the same as ever; what was allocated is freed; the next picture is right again.
//
// alloc_failures [--quick] [--from N] [--to N] [--verbose]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "failures/failing_allocator.h"
#include "openrt/openrt.h"
#include "xvrml/browser.h"
#include "xvrml/openrt.h"

namespace {

constexpr int width = 24, height = 16;
constexpr char worldText[] = R"(#VRML V2.0 utf8
PROTO Ball [ field SFColor paint 1 0 0 exposedField SFVec3f place 0 0 0 ] {
  Transform {
    translation IS place
    children Shape { appearance Appearance { material Material { diffuseColor IS paint } } geometry Sphere { radius 0.4 } }
  }
}
Viewpoint { position 0 0 8 description "front" }
NavigationInfo { headlight TRUE }
Background { skyColor 0.1 0.1 0.2 }
PointLight { location 2 3 4 }
Shape { appearance Appearance { material Material { } texture ImageTexture { url "picture.png" } } geometry Box { } }
Transform { translation -3 1 0 children Shape { geometry Text { string [ "ab" "c" ] } } }
Transform {
  translation 2 0 0
  children [ Ball { } Ball { paint 0 1 0 place 0 1 0 } DEF Moving Ball { paint 0 0 1 place 0 2 0 } ]
}
DEF Hills Transform {
  translation -3 -2 0 scale 0.2 0.2 0.2
  children ORTInstance {
    children Shape {
      geometry ElevationGrid {
        xDimension 4 zDimension 4 creaseAngle 1
        height [ 0 1 0 1, 1 0 1 0, 0 2 0 1, 1 0 1 0 ]
        color Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 0, 0 1 1, 1 0 1, 1 1 1, 0 0 0, 1 0 0 ] } colorPerVertex FALSE
      }
    }
  }
}
Transform { translation 3 0 0 children USE Hills }
Shape { geometry IndexedFaceSet {
  coord Coordinate { point [ -1 -2 0, 1 -2 0, 1 -1 0, 0 -1.5 0, -1 -1 0 ] } coordIndex [ 0 1 2 3 4 -1 ] convex FALSE } }
Inline { url "part.wrl" }
DEF Program Script {
  eventIn SFFloat go
  eventOut SFVec3f out
  url "javascript: function go(v) { out = new SFVec3f(v, 2, 0); }"
}
ROUTE Program.out TO Moving.place
)";
constexpr char partText[] = "#VRML V2.0 utf8\nTransform { translation 0 2.5 0 children Shape { geometry Cone { } } }\n";

struct Outcome {
  bool threw = false;
  RTenum error = RT_NO_ERROR;
  std::string messages;
  std::vector<float> pixels;
  bool told() const { return threw || error != RT_NO_ERROR || !messages.empty(); }
};

struct Context {
  RTcontext context = rtNewContext("threads=1");
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() {
    if (context) rtDeleteContext(context);
  }
};

void draw(xvrml::Browser& browser, Outcome& outcome) {
  const Context context;
  if (!context.context) {
    outcome.error = rtGetError();
    return;
  }
  {
    xvrml::OpenRTMapper mapper(browser.world(), xvrml::MapOptions());
    const auto program = browser.node("Program");
    if (program) browser.set(*program, "go", 0.5f);
    browser.tick(1);
    mapper.update(browser.takeChanges());
    mapper.map(mapper.viewpointCamera(0));
    rtFrameBuffer(width, height, RT_RGBA);
    rtRender();
    std::vector<float> pixels(size_t(width) * height * 4);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    outcome.error = rtGetError();
    if (outcome.error == RT_NO_ERROR) outcome.pixels = std::move(pixels);
  }
}

Outcome work(const std::string& path) {
  Outcome outcome;
  try {
    xvrml::BrowserOptions options;
    options.scriptPath = FAILURES_SCRIPTS;
    options.trustScripts = true;
    options.scriptIsolation = xvrml::BrowserOptions::Isolation::never;
    xvrml::Browser browser(xvrml::loadWorld(path), options, 0);
    try {
      draw(browser, outcome);
    } catch (const std::exception&) { outcome.threw = true; }
    const xvrml::Diagnostics& diagnostics = browser.world().diagnostics;
    for (const xvrml::Diagnostic& one : diagnostics.list()) outcome.messages += one.text() + "\n";
    if (diagnostics.dropped() > 0) outcome.messages += "dropped\n";
  } catch (const xvrml::LoadError&) { outcome.threw = true; } catch (const std::exception&) {
    outcome.threw = true;
  }
  return outcome;
}

struct Options {
  bool quick = false, verbose = false;
  uint64_t from = 1, to = ~uint64_t(0);
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") options.quick = true;
    if (word == "--verbose") options.verbose = true;
    if (word == "--from" && i + 1 < argc) options.from = std::strtoull(argv[++i], nullptr, 10);
    if (word == "--to" && i + 1 < argc) options.to = std::strtoull(argv[++i], nullptr, 10);
  }
  return options;
}

class Sweep {
 public:
  Sweep(std::string path, const Options& options) : path_(std::move(path)), options_(options) {}

  int run() {
    for (int i = 0; i < 3; ++i) reference_ = work(path_); // fills what is kept for the life of the process: fonts, plug-ins
    if (reference_.told() || reference_.pixels.empty()) {
      std::printf("fault: without any failure: %s\n", reference_.messages.c_str());
      return 1;
    }
    failing_allocator::locate();
    failing_allocator::arm(0);
    (void)work(path_);
    const uint64_t all = failing_allocator::disarm();
    std::printf("%llu allocations\n", static_cast<unsigned long long>(all));
    const uint64_t last = std::min(options_.to, all), step = options_.quick ? std::max<uint64_t>(1, all / 150) : 1;
    for (uint64_t number = options_.from; number <= last; number += step) {
      if (options_.verbose) std::printf("%llu\n", static_cast<unsigned long long>(number)), std::fflush(stdout);
      fail(number);
    }
    std::printf("%llu failed, told by an exception: %llu, by rtGetError: %llu, by a message: %llu, without effect: %llu; "
                "%llu faults\n",
                static_cast<unsigned long long>(runs_), static_cast<unsigned long long>(threw_),
                static_cast<unsigned long long>(errors_), static_cast<unsigned long long>(messages_),
                static_cast<unsigned long long>(same_), static_cast<unsigned long long>(faults_));
    return faults_ > 0 || runs_ == 0;
  }

 private:
  void fail(uint64_t number) {
    const int64_t before = failing_allocator::blocks();
    Outcome outcome;
    failing_allocator::arm(number);
    outcome = work(path_);
    failing_allocator::disarm();
    if (!failing_allocator::failed()) return; // threads: there may be some fewer this time
    ++runs_;
    const bool same = outcome.pixels == reference_.pixels;
    if (outcome.threw)
      ++threw_;
    else if (outcome.error != RT_NO_ERROR)
      ++errors_;
    else if (!outcome.messages.empty())
      ++messages_;
    else if (same)
      ++same_;
    else
      fault(number, "another picture, and nothing told");
    const std::string messages = std::move(outcome.messages);
    outcome = Outcome();
    // A cache that was being filled may hold something for the first time; a second run shows whether it was lost instead.
    const bool clean = work(path_).pixels == reference_.pixels;
    if (!clean) fault(number, "the next picture is wrong");
    if (const int64_t more = failing_allocator::blocks() - before; more > 0)
      fault(number, (std::to_string(more) + " blocks are not freed; " + messages).c_str());
  }

  void fault(uint64_t number, const char* what) {
    ++faults_;
    std::printf("fault: allocation %llu: %s\n", static_cast<unsigned long long>(number), what);
    std::fflush(stdout);
  }

  std::string path_;
  Options options_;
  Outcome reference_;
  uint64_t runs_ = 0, threw_ = 0, errors_ = 0, messages_ = 0, same_ = 0, faults_ = 0;
};

} // namespace

int main(int argc, char** argv) {
  std::string folder = (std::filesystem::temp_directory_path() / "openrt-alloc-XXXXXX").string();
  if (!mkdtemp(folder.data())) return 1;
  std::ofstream(folder + "/world.wrl") << worldText;
  std::ofstream(folder + "/part.wrl") << partText;
  std::filesystem::copy_file(FAILURES_PICTURE, folder + "/picture.png");
  const int result = Sweep(folder + "/world.wrl", parse(argc, argv)).run();
  std::filesystem::remove_all(folder);
  return result;
}
