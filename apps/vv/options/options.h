// options.h: Holds the values of the command line, and the one table of options that parses it and
// prints --help. main() calls this once. [one thread]
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libpicture/cluster.h"
#include "libpicture/export/export.h"
#include "libpicture/files/film.h"
#include "libpicture/files/formats.h"
#include "libpicture/renderer.h"
#include "libpicture/shader_rules.h"
#include "options/values.h"
#include "xvrml/world.h"

namespace vv {

struct InputScript;
struct OptionInfo;

struct Output {
  std::string path;                        // "-": standard output
  const picture::Format* format = nullptr; // never null in a file of one picture
  // Not none: the file holds all pictures of a sequence, and `format` is null.
  picture::FilmKind film = picture::FilmKind::none;
  bool raw = false; // --raw: writes pictures as they were before --denoise, too
  const char* option() const { return raw ? "--raw" : "-o"; }
};

// A job that is done instead of making a picture or opening the window: it prints something, adds
// pictures, serves a page, or opens the window with the editor. If several are asked for, the first
// of these is done.
enum class Job : uint8_t {
  help,
  version,
  merge,
  compare,
  film,
  serve,
  edit,
  listKeys,
  info,
  explain,
  listNodes,
  listViewpoints,
  listShaders,
  listEngines,
  listFeatures
};
struct JobInfo {
  Job job;
  const char* name; // the option, or the command without dashes, that asks for the job
  bool inspects;    // the job prints facts, as JSON with --json; only one such job can be asked for
  bool needsWorld;  // the job needs a FILE
};
inline constexpr JobInfo jobTable[] = {
    {Job::help, "--help", false, false},
    {Job::version, "--version", false, false},
    {Job::merge, "merge", false, false},
    {Job::compare, "compare", false, false},
    {Job::film, "film", false, false},
    {Job::serve, "serve", false, true},
    {Job::edit, "edit", false, true},
    {Job::listKeys, "--list-keys", false, false},
    {Job::info, "--info", true, true},
    {Job::explain, "--explain", true, true},
    {Job::listNodes, "--list-nodes", true, false},
    {Job::listViewpoints, "--list-viewpoints", true, true},
    {Job::listShaders, "--list-shaders", true, false},
    {Job::listEngines, "--list-engines", true, false},
    {Job::listFeatures, "--list-features", true, false},
};
// Where `vv serve` shows its page.
struct ServeOptions {
  int port = 8097;     // 0: any free port
  std::string address; // IP address; empty: this machine alone
  // A text, @FILE, or "new" for random characters; empty: as the environment says, or none.
  std::string token;
  bool edit = false; // those who have a second token may edit the world
};

// The pictures of vv compare.
struct CompareOptions {
  std::vector<std::string> files;            // two
  std::optional<std::array<int, 2>> samples; // samples per pixel of each
};

// Says which seeds a picture is made of.
struct SeedRange {
  uint32_t first = 0, last = 0;
  uint32_t count() const { return last - first + 1; }
};

struct Options {
  std::string input; // "-": standard input; empty: none given
  std::vector<Output> outputs;
  picture::RenderSettings render;
  picture::ClusterSettings cluster;
  std::optional<int> samples; // value of --samples; render.samples is the number in use
  static constexpr int measureSamples = 4096; // for sensors, if nothing says how many
  picture::View view;
  std::optional<double> time; // seconds since the world was loaded
  // Seconds since 1970 when the world is loaded. None: xvrml::worldEpoch, or the real time in the
  // window.
  std::optional<double> epoch;
  std::optional<FrameRange> frames;
  bool missing = false; // only the frames that are absent or damaged
  int farmJobs = 0;     // commands that the sequence is cut into; 0: its pictures are made here
  double fps = 30;      // rate of frames and films; also the step of the world's clock
  int turntable = 0;    // number of pictures around the world; 0: none
  std::vector<std::string> definitions; // texts of the form DEF.field=value
  std::vector<picture::ShaderRule> shaders;
  bool placeholders = false;       // boxes stand for Inlines that cannot be read
  std::string cameraShader;        // text of the form Class:param=value
  std::string cameraShaderFolder;  // confines the files that it names; empty: anywhere
  std::vector<picture::Side> from; // sides that the model is seen from
  std::string viewpoint;           // viewpoint as given: a name, a number or "all"
  bool check = false, strict = false;
  bool json = false;
  std::string helpTopic; // the topic of --help; empty: none
  std::vector<Job> jobs; // requested jobs, in any order
  bool watch = false;
  std::string inputScript, recordInput;      // files of user input; empty: none
  std::shared_ptr<const InputScript> script; // contents of inputScript (readScript)
  std::string write, stats;
  xvrml::Encoding writeEncoding = xvrml::Encoding::vrml97; // the encoding of --write
  const picture::ExportFormat* writeFormat = nullptr;      // stands in place of it if not null
  std::string compare;                                     // reference picture; empty: none
  int audit = 0; // number of pictures to check the error bars with; 0: none
  ServeOptions serve;
  std::string nodePath; // folders, separated by colons
  xvrml::LoadOptions load;
  xvrml::BrowserOptions running;
  xvrml::RunOptions run; // options of the Browser; startWorld sets the epoch
  bool quiet = false, verbose = false;
  std::string control; // address where programs control the world; empty: none
  bool noWindow = false;
  // Pictures show luminance in colours; the end of the scale in cd/m2, 0: chosen by the first.
  std::optional<double> falseColour;
  bool viewGiven = false;         // the view transform was chosen by --exposure or --view
  std::string resume;             // file that an interrupted picture is continued from; empty: none
  double resumeEvery = 60;        // seconds between two writes of that file
  bool sums = false;              // EXR files get the sums of their pictures
  SeedRange seeds;                // the first one is also in render.quality
  std::vector<std::string> merge; // files whose sums are added (vv merge)
  std::vector<std::string> joined; // pictures that become a film (vv film --join)
  bool denoise = false;            // files and films of -o hold denoised pictures
  std::string poseFile;            // the file of --pose; empty: none
  bool posed = false;              // view.lookAt is that of --pose
  bool fitExposure = false;        // render.view.exposure is chosen by the first picture
  std::string measure; // file for the readings of the sensors, .csv, .json or .html; empty: none
  std::string skyText; // the words of --sky; empty: none
  std::vector<const OptionInfo*> given; // options that the command line or a preset sets
  CompareOptions compared;
  // Denoised pictures are audited, and the run fails if a larger share of one is doubtful.
  std::optional<double> mostDoubt;

  // Tells whether the command line or a preset sets the option with this name.
  bool isGiven(std::string_view name) const;
  bool allViewpoints() const { return viewpoint == "all"; }
  // Tells whether each moment has several pictures, whose names say which.
  bool severalViews() const { return allViewpoints() || from.size() > 1; }
  bool makesPictures() const {
    return !outputs.empty() || !compare.empty() || audit > 0 || measures();
  }
  // Tells whether the sums of the picture are kept, because they are written or added.
  bool keepsSums() const { return !resume.empty() || sums || seeds.count() > 1; }
  bool measures() const { return !measure.empty(); }
  bool opensWindow() const {
    return !makesPictures() && !check && write.empty() && (!job() || !job()->inspects) &&
           !has(Job::merge) && !has(Job::compare) && !has(Job::film) && !has(Job::serve) &&
           !has(Job::listKeys);
  }
  // Tells whether the world runs and somebody looks at it, in the window or on a page.
  bool showsWorld() const { return opensWindow() || has(Job::serve); }
  bool has(Job wanted) const { return std::find(jobs.begin(), jobs.end(), wanted) != jobs.end(); }
  // Returns the job to do; null if none was asked for.
  const JobInfo* job() const;
  bool isSequence() const { return frames || turntable > 0; }
  // Tells whether the turntable goes round from the first side of --from.
  bool turnsFirstSide() const { return !from.empty() && turntable > 0; }
  // Tells whether it does so for films only; other files then get the picture at its beginning.
  bool turnsIntoFilm() const {
    return turnsFirstSide() &&
           std::any_of(outputs.begin(), outputs.end(),
                       [](const Output& output) { return output.film != picture::FilmKind::none; });
  }
};

// Counts the inspections (--info, --list-nodes ...) that are asked for.
int inspectionsOf(const Options& options);
// Throws UsageError with one line that names the option and says what was expected.
Options readCommandLine(int argc, char** argv);

} // namespace vv
