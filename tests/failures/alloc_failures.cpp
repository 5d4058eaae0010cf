// alloc_failures.cpp: makes every allocation fail once. A small world with textures, text,
// prototypes, an Inline, a Script that adds and removes nodes, instances and moving parts is
// loaded, run, drawn and written. This is repeated for each allocation that the project's libraries
// make, with this one failing. Each time:
// * the process does not crash or hang;
// * an exception, a message or rtGetError() reports the error, or the picture is unchanged;
// * everything allocated is freed;
// * the next picture is correct again.
//
// Allocations that Embree, TBB and other libraries make for themselves never fail here.
//
// The work is done in a process of its own. If it crashes or hangs, that is reported, and another
// process continues with the next number.
//
// alloc_failures [--quick] [--from N] [--to N] [--here] [--verbose]
//   --quick        every n-th allocation only, about 120 of them
//   --from, --to   these allocations only
//   --here         in this process, for a debugger
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "failures/failing_allocator.h"
#include "openrt/openrt.h"
#include "xvrml/browser.h"
#include "xvrml/mapper.h"
#include "xvrml/world.h"

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
Background { skyColor [ 0.1 0.1 0.2, 0.4 0.4 0.5 ] skyAngle 1.5 frontUrl "picture.png" }
Fog { color 0.5 0.5 0.5 visibilityRange 90 }
PointLight { location 2 3 4 }
SpotLight { location 0 3 4 direction 0 -1 -1 intensity 0.5 }
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
Shape { geometry IndexedLineSet { coord Coordinate { point [ -4 -3 0, 4 -3 0, 4 3 0 ] } coordIndex [ 0 1 2 -1 ] } }
Billboard { children LOD { range 20 level [ Shape { geometry PointSet { coord Coordinate { point [ 0 -3 1, 1 -3 1 ] } } } ] } }
Transform { translation 0 0 -3 children Shape {
  appearance Appearance { material Material { } texture PixelTexture { image 2 2 3 0xFF0000 0x00FF00 0x0000FF 0xFFFFFF } }
  geometry Extrusion { crossSection [ 1 0, 0 1, -1 0, 1 0 ] spine [ 0 0 0, 0 1 0, 1 2 0 ] } } }
Transform { translation 0 -2.5 1 children Shape {
  appearance ORTAppearance { shader ORTShader {
    name "Plastic" file "plastic" options [ "color color .2 .5 .7" "1f roughness .1" ] } }
  geometry Box { size 0.5 0.5 0.5 } } }
Inline { url "part.wrl" }
DEF Room Group { children DEF Old Ball { place 0 -2 2 } }
DEF Clock TimeSensor { cycleInterval 4 loop TRUE }
DEF Path PositionInterpolator { key [ 0, 1 ] keyValue [ 0 0 0, 1 1 0 ] }
DEF Slide Transform { children Shape { geometry Cylinder { radius 0.2 } } }
ROUTE Clock.fraction_changed TO Path.set_fraction
ROUTE Path.value_changed TO Slide.set_translation
DEF Program Script {
  directOutput TRUE
  eventIn SFFloat go
  eventOut SFVec3f out
  field SFNode room USE Room
  field MFNode old USE Old
  url "javascript: function go(v) {
    out = new SFVec3f(v, 2, 0);
    room.removeChildren = old;
    room.addChildren = Browser.createVrmlFromString('Transform { translation 0 -2 2 children Shape { geometry Cone { } } }');
  }"
}
ROUTE Program.out TO Moving.place
)";
constexpr char partText[] =
    "#VRML V2.0 utf8\nTransform { translation 0 2.5 0 children Shape { geometry Cone { } } }\n";

struct Outcome {
  bool threw = false;
  RTenum error = RT_NO_ERROR;
  std::string messages;
  std::vector<float> pixels;
  std::string written; // the world as a file
  bool same(const Outcome& other) const {
    return pixels == other.pixels && written == other.written;
  }
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
    browser.tick(2);
    mapper.update(browser.takeChanges());
    mapper.map(mapper.viewpointCamera(0));
    rtFrameBuffer(width, height, RT_RGBA);
    rtRender();
    std::vector<float> pixels(size_t(width) * height * 4);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    outcome.error = rtGetError();
    if (outcome.error == RT_NO_ERROR) outcome.pixels = std::move(pixels);
  }
  outcome.written = xvrml::writeWorld(browser.world());
}

Outcome work(const std::string& path) {
  Outcome outcome;
  try {
    xvrml::BrowserOptions options;
    options.scriptPath = FAILURES_SCRIPTS;
    options.trustScripts = true;
    options.scriptSeconds = 600; // the machine may be busy
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
  bool quick = false, verbose = false, here = false;
  uint64_t from = 1, to = ~uint64_t(0);
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") options.quick = true;
    if (word == "--verbose") options.verbose = true;
    if (word == "--here") options.here = true;
    if (word == "--from" && i + 1 < argc) options.from = std::strtoull(argv[++i], nullptr, 10);
    if (word == "--to" && i + 1 < argc) options.to = std::strtoull(argv[++i], nullptr, 10);
  }
  return options;
}

// Results of the working processes, in memory shared with the process that watches them.
struct Tally {
  // Allocation numbers: the total, the next to fail, the one that fails now (0: none).
  std::atomic<uint64_t> all{0}, next{1}, at{0};
  std::atomic<uint64_t> runs{0}, threw{0}, errors{0}, messages{0}, same{0}, faults{0};
};
static_assert(std::atomic<uint64_t>::is_always_lock_free);

void fault(Tally& tally, uint64_t number, const std::string& what) {
  ++tally.faults;
  std::printf("fault: allocation %llu: %s\n", static_cast<unsigned long long>(number),
              what.c_str());
  std::fflush(stdout);
}

// Makes one allocation after the other fail, from tally.next on. [a working process]
class Sweep {
 public:
  Sweep(std::string path, const Options& options, Tally& tally)
      : path_(std::move(path)), options_(options), tally_(tally) {}

  int run() {
    for (int i = 0; i < 3; ++i)
      reference_ = work(path_); // fills caches that live as long as the process: fonts, plug-ins
    if (reference_.told() || reference_.pixels.empty()) {
      std::printf("fault: without any failure: %s\n", reference_.messages.c_str());
      return 1;
    }
    failing_allocator::locate();
    failing_allocator::arm(0);
    const bool repeated = work(path_).same(reference_);
    const uint64_t all = failing_allocator::disarm();
    constexpr uint64_t least = 1000; // fewer mean that the project's libraries were not recognized
    if (all < least) {
      std::printf("fault: only %llu allocations were seen\n", static_cast<unsigned long long>(all));
      return 1;
    }
    if (!repeated) {
      std::printf("fault: without any failure: another picture each time\n");
      return 1;
    }
    if (tally_.all == 0) {
      std::printf("%llu allocations\n", static_cast<unsigned long long>(all));
      std::fflush(stdout);
    }
    tally_.all = all;
    constexpr uint64_t few = 120;
    const uint64_t last = std::min(options_.to, all),
                   step = options_.quick ? std::max<uint64_t>(1, all / few) : 1;
    while (tally_.next <= last) {
      const int64_t before = failing_allocator::blocks();
      std::vector<uint64_t> tried;
      while (tried.size() < batch && tally_.next <= last) {
        tried.push_back(tally_.next.fetch_add(
            step)); // if this one ends the process, the next process starts after it
        count(tried.back(), attempt(tried.back()));
      }
      if (!isSound(before)) lookAtEach(tried);
    }
    return 0;
  }

 private:
  static constexpr size_t batch = 8; // failures between two checks that everything is as before

  Outcome attempt(uint64_t number) {
    if (options_.verbose) {
      std::printf("%llu\n", static_cast<unsigned long long>(number));
      std::fflush(stdout);
    }
    tally_.at = number;
    failing_allocator::arm(number);
    Outcome outcome = work(path_);
    failing_allocator::disarm();
    tally_.at = 0;
    return outcome;
  }

  void count(uint64_t number, const Outcome& outcome) {
    // With threads there may be fewer allocations this time.
    if (!failing_allocator::failed()) return;
    ++tally_.runs;
    if (outcome.threw)
      ++tally_.threw;
    else if (outcome.error != RT_NO_ERROR)
      ++tally_.errors;
    else if (!outcome.messages.empty())
      ++tally_.messages;
    else if (outcome.same(reference_))
      ++tally_.same;
    else
      fault(tally_, number,
            outcome.pixels == reference_.pixels ? "another file, and nothing told"
                                                : "another picture, and nothing told");
  }

  // Returns whether a run without failure gives the right picture and leaves nothing behind. A
  // cache may hold something new that an earlier run was filling. If this run fills it as well, it
  // was not lost.
  bool isSound(int64_t before) {
    const bool same = work(path_).same(reference_);
    return same && failing_allocator::blocks() <= before;
  }

  // Checks these numbers one by one, because something went wrong with one of them or a cache has
  // grown.
  void lookAtEach(const std::vector<uint64_t>& numbers) {
    for (const uint64_t number : numbers) {
      const int64_t before = failing_allocator::blocks();
      const std::string messages = attempt(number).messages;
      if (const Outcome next = work(path_); !next.same(reference_))
        fault(tally_, number,
              "the next picture is wrong: error " + std::to_string(next.error) +
                  (next.threw ? ", thrown; " : "; ") + next.messages);
      if (const int64_t more = failing_allocator::blocks() - before; more > 0)
        fault(tally_, number, std::to_string(more) + " blocks are not freed; " + messages);
    }
  }

  std::string path_;
  Options options_;
  Tally& tally_;
  Outcome reference_;
};

// Runs the work in one process after the other and reports processes that crash or hang. Returns
// false if nothing could be tested.
bool watch(Sweep& sweep, Tally& tally) {
  constexpr int patience = 120; // seconds for one allocation, long enough for a busy machine
  constexpr uint64_t maxDeaths = 50;
  for (uint64_t deaths = 0; deaths < maxDeaths;) {
    std::fflush(stdout);
    const pid_t process = fork();
    if (process < 0) return false;
    if (process == 0) {
      const int result = sweep.run();
      std::fflush(stdout);
      _exit(result);
    }
    int status = 0;
    bool hangs = false;
    uint64_t last = tally.next;
    time_t since = time(nullptr);
    while (waitpid(process, &status, WNOHANG) == 0) {
      const timespec pause = {0, 50'000'000};
      nanosleep(&pause, nullptr);
      if (const uint64_t next = tally.next; next != last) {
        last = next;
        since = time(nullptr);
      }
      if (time(nullptr) - since <= patience) continue;
      hangs = true;
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
      break;
    }
    if (WIFEXITED(status)) return WEXITSTATUS(status) == 0;
    ++deaths;
    const uint64_t at = tally.at.exchange(0);
    if (at == 0) return false;
    fault(tally, at,
          hangs ? "hangs" : std::string("ends the process: ") + strsignal(WTERMSIG(status)));
  }
  std::printf("fault: too many processes have ended\n");
  return false;
}

} // namespace

int main(int argc, char** argv) {
  std::string folder = (std::filesystem::temp_directory_path() / "openrt-alloc-XXXXXX").string();
  if (!mkdtemp(folder.data())) return 1;
  std::ofstream(folder + "/world.wrl") << worldText;
  std::ofstream(folder + "/part.wrl") << partText;
  std::filesystem::copy_file(FAILURES_PICTURE, folder + "/picture.png");
  void* const shared =
      mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 1;
  Tally& tally = *new (shared) Tally;
  const Options options = parse(argc, argv);
  tally.next = std::max<uint64_t>(1, options.from);
  Sweep sweep(folder + "/world.wrl", options, tally);
  const bool finished = options.here ? sweep.run() == 0 : watch(sweep, tally);
  std::filesystem::remove_all(folder);
  const auto count = [](const std::atomic<uint64_t>& n) {
    return static_cast<unsigned long long>(n);
  };
  std::printf("%llu failed, told by an exception: %llu, by rtGetError: %llu, by a message: %llu, "
              "without effect: %llu; %llu faults\n",
              count(tally.runs), count(tally.threw), count(tally.errors), count(tally.messages),
              count(tally.same), count(tally.faults));
  return !finished || tally.faults > 0 || tally.runs == 0;
}
