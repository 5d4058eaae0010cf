// report.cpp: Builds the reports.
#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <sys/resource.h>

#include "denoised_json.h"
#include "describe.h"
#include "json_text.h"
#include "libpicture/worker_facts.h"
#include "transport_words.h"
#include "xvrml/nodes.h"
#include "xvrml/script_engines.h"

namespace vv {

namespace {

// Returns the error estimate of the whole picture, relative (openrt.h, RTerrorStats). Samples that
// are no replicates bound the error of the picture only loosely, and statistics do not change how a
// picture is made: nothing is said about it unless the user has asked for errors.
Json errorEstimate(const RTerrorStats& s, bool asked) {
  const bool known = s.pixels > 0 && asked;
  const auto value = [known](double x) { return known ? Json(x) : Json(nullptr); };
  return {{"mean_rel", value(s.mean)},
          {"mean_rel_interval", value(s.meanInterval)},
          {"half_width", value(s.halfWidth)},
          {"p99", value(s.p99)},
          {"pixels_trusted", value(known ? double(s.trusted) / double(s.pixels) : 0)},
          {"unmet", value(s.unmet)},
          {"level", s.level},
          {"method", asked ? s.method : "none: --channels rgba,error,trust or --error tells it"}};
}

// Returns the state of the cluster since the program began to connect to the workers. `tiles`
// counts jobs, which may be parts of tiles.
Json clusterJson(const picture::RenderResult& result) {
  const RTclusterStats& s = result.stats.cluster;
  Json machines = Json::array();
  for (const RTworker& worker : result.workers) {
    Json machine;
    picture::forEachWorkerFact([&](const picture::WorkerFact& fact, auto get) {
      machine[fact.key] = std::invoke(get, worker);
    });
    machines.push_back(std::move(machine));
  }
  return {{"workers", s.workers},           {"tiles", s.tilesRemote},
          {"tiles_here", s.tilesLocal},     {"retries", s.reissued},
          {"duplicates", s.duplicates},     {"bytes", s.bytesSent + s.bytesReceived},
          {"bytes_sent", s.bytesSent},      {"bytes_received", s.bytesReceived},
          {"machines", std::move(machines)}};
}

uint64_t peakMemory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

Json channelNames(uint32_t channels) {
  Json names = Json::array();
  for (const picture::Channel& channel : picture::channelTable())
    if (channels & channel.bit) names.push_back(channel.name);
  return names;
}

Json viewpointsJson(const std::vector<xvrml::ViewpointInfo>& viewpoints) {
  Json list = Json::array();
  for (size_t i = 0; i < viewpoints.size(); ++i) {
    const xvrml::ViewpointInfo& v = viewpoints[i];
    list.push_back({{"index", i},
                    {"name", v.name},
                    {"description", v.description},
                    {"matrix", Json(v.matrix)}});
  }
  return list;
}

// Returns the number of samples taken per pixel, averaged over the picture; null if the picture has
// no channel of samples.
Json meanSamples(const picture::RenderResult& result) {
  const auto plane = result.picture.planes.find(RT_SAMPLES);
  if (plane == result.picture.planes.end() || plane->second.empty()) return nullptr;
  double sum = 0;
  for (const float n : plane->second) sum += double(n);
  return sum / double(plane->second.size());
}

// Returns the statistics common to a picture and a sequence; the numbers are those of the last
// picture.
Json sceneStats(const Options& options, const std::string& commandLine, const RunningWorld& running,
                const picture::RenderResult& result, const Json& samples) {
  const xvrml::World& world = running.world;
  const RTstats& s = result.stats;
  const picture::RenderSettings& r = options.render;
  Json json;
  json["schema"] = 1;
  json["version"] = version();
  json["command"] = commandLine;
  json["interrupted"] = result.interrupted;
  json["scene"] = {{"path", world.path},
                   {"nodes", world.nodeCount},
                   {"shapes", result.map.shapes},
                   {"triangles", s.scene.triangles},
                   {"unique_triangles", s.scene.uniqueTriangles},
                   {"objects", s.scene.objects},
                   {"instances", s.scene.instances},
                   {"textures", s.scene.textures},
                   {"lights", s.scene.lights},
                   {"warnings", world.diagnostics.warnings() + world.diagnostics.errors()}};
  json["scripts"] = {{"scripts", running.scripts.scripts},
                     {"started", running.scripts.started},
                     {"calls", running.scripts.calls},
                     {"seconds", running.scripts.seconds}};
  json["image"] = {{"width", r.width},
                   {"height", r.height},
                   {"spp", r.samples},
                   {"spp_mean", samples},
                   {"channels", channelNames(r.channels)}};
  if (const picture::ViewTransform& view = result.picture.view; !view.isPlain()) {
    json["image"]["exposure"] = view.exposure;
    json["image"]["view"] = picture::curveName(view.curve);
  }
  if (const picture::Crop& c = r.crop; c.width > 0)
    json["image"]["crop"] = {c.x, c.y, c.width, c.height};
  if (options.seeds.count() > 1) {
    json["image"]["spp"] = uint64_t(r.samples) * options.seeds.count();
    json["image"]["seeds"] = options.seeds.count();
  }
  if (r.preview) json["image"]["preview"] = true;
  if (!result.picture.denoisedBy.empty()) json["image"]["denoised"] = denoisedJson(result);
  return json;
}

void addMachine(Json& json, const Options& options, const picture::RenderResult& result) {
  const RTstats& s = result.stats;
  json["transport"] = transportJson(result.stats, options.render);
  const picture::RenderSettings& r = options.render;
  json["error"] = errorEstimate(s.error, (r.channels & (RT_ERROR | RT_TRUST)) || r.error > 0 ||
                                             r.timeLimit > 0);
  json["left_out"] = {{"cut_by_depth", s.leftOut.cutByDepth},
                      {"cut_by_energy", s.leftOut.cutByEnergy},
                      {"clipped", s.leftOut.clipped},
                      {"unreached_lights", s.transport.unreachedLights},
                      {"shader_faults", s.leftOut.shaderFaults},
                      {"wrong_hits", s.rejected.hits},
                      {"rejected_rays", s.rejected.rays}};
  json["memory"] = {{"peak_rss", peakMemory()}, {"bvh", s.bvh.bytes}, {"scene", nullptr}};
  json["cluster"] = clusterJson(result);
  json["machine"] = {
      {"isa", s.machine.isa}, {"threads", s.machine.threads}, {"embree", s.machine.kernel}};
}

Json rayStats(const RTrayStats& rays) {
  return {{"camera", rays.camera}, {"shadow", rays.shadow}, {"secondary", rays.secondary}};
}

Json rayStats(const RTrayStats& rays, double seconds) {
  Json json = rayStats(rays);
  const auto all = double(rays.camera + rays.shadow + rays.secondary);
  json["per_second"] = seconds > 0 ? all / seconds : 0.0;
  return json;
}

} // namespace

std::string statsJson(const Options& options, const std::string& commandLine,
                      const RunningWorld& running, const picture::RenderResult& result,
                      const RunTimes& times) {
  const RTstats& s = result.stats;
  const xvrml::World& world = running.world;
  Json json = sceneStats(options, commandLine, running, result, meanSamples(result));
  // A picture has a single pass.
  json["time"] = {{"parse", world.times.parse},
                  {"graph", world.times.load},
                  {"start", times.start},
                  {"map", result.mapSeconds},
                  {"build", s.time.commit + s.time.build},
                  {"first_pass", result.renderSeconds},
                  {"render", result.renderSeconds},
                  {"write", times.write},
                  {"total", times.total}};
  if (result.denoiseSeconds > 0) json["time"]["denoise"] = result.denoiseSeconds;
  json["rays"] = rayStats(s.rays, s.time.render);
  addMachine(json, options, result);
  return dump(json);
}

std::string mergedStatsJson(const std::string& commandLine, const picture::Sums& sums,
                            const RTstats& s) {
  const RTsumsInfo info = sums.info();
  Json json;
  json["schema"] = 1;
  json["version"] = version();
  json["command"] = commandLine;
  json["image"] = {{"width", info.width},
                   {"height", info.height},
                   {"spp", uint64_t(info.samples) * info.seeds},
                   {"seeds", info.seeds},
                   {"channels", channelNames(info.channels)}};
  json["error"] = errorEstimate(s.error, std::strncmp(s.error.method, "replicated", 10) == 0 ||
                                             (info.channels & (RT_ERROR | RT_TRUST)));
  json["left_out"] = {{"cut_by_depth", s.leftOut.cutByDepth},
                      {"cut_by_energy", s.leftOut.cutByEnergy},
                      {"clipped", s.leftOut.clipped},
                      {"shader_faults", s.leftOut.shaderFaults}};
  json["rays"] = rayStats(s.rays);
  json["machine"] = {{"isa", s.machine.isa}, {"embree", s.machine.kernel}};
  return dump(json);
}

struct SequenceStats::Impl {
  Json frames = Json::array();
  picture::RenderResult last{}; // the last result, without the pixels
  Json samples;                 // mean number of samples of the last picture
  double map = 0, build = 0, render = 0, denoise = 0, write = 0, first = 0, tracing = 0;
  RTrayStats rays{};
};

SequenceStats::SequenceStats() : impl_(std::make_unique<Impl>()) {}
SequenceStats::~SequenceStats() = default;

void SequenceStats::add(const PictureName& name, double worldTime,
                        const picture::RenderResult& result, double writeSeconds) {
  Impl& sum = *impl_;
  const RTstats& s = result.stats;
  const double build = s.time.commit + s.time.build;
  Json frame = {{"frame", name.frame.value_or(0)}, {"world_time", worldTime}};
  if (!name.viewpoint.empty()) frame["viewpoint"] = name.viewpoint;
  frame["time"] = {{"map", result.mapSeconds},
                   {"build", build},
                   {"render", result.renderSeconds},
                   {"write", writeSeconds}};
  if (result.denoiseSeconds > 0) frame["time"]["denoise"] = result.denoiseSeconds;
  if (result.doubt) frame["doubt"] = doubtJson(*result.doubt);
  if (sum.frames.empty()) sum.first = result.renderSeconds;
  sum.frames.push_back(std::move(frame));
  sum.map += result.mapSeconds;
  sum.build += build;
  sum.render += result.renderSeconds;
  sum.denoise += result.denoiseSeconds;
  sum.write += writeSeconds;
  sum.tracing += s.time.render;
  sum.rays.camera += s.rays.camera;
  sum.rays.shadow += s.rays.shadow;
  sum.rays.secondary += s.rays.secondary;
  sum.samples = meanSamples(result);
  sum.last.map = result.map;
  sum.last.picture.view = result.picture.view;
  sum.last.stats = s;
  if (!result.interrupted) sum.last.picture.denoisedBy = result.picture.denoisedBy;
  sum.last.workers = result.workers;
  sum.last.interrupted |= result.interrupted;
}

std::string SequenceStats::json(const Options& options, const std::string& commandLine,
                                const RunningWorld& running, double startSeconds,
                                double totalSeconds) const {
  const Impl& sum = *impl_;
  const xvrml::World& world = running.world;
  Json json = sceneStats(options, commandLine, running, sum.last, sum.samples);
  json["time"] = {{"parse", world.times.parse}, {"graph", world.times.load},
                  {"start", startSeconds},      {"map", sum.map},
                  {"build", sum.build},         {"first_pass", sum.first},
                  {"render", sum.render},       {"write", sum.write},
                  {"total", totalSeconds}};
  if (sum.denoise > 0) json["time"]["denoise"] = sum.denoise;
  json["rays"] = rayStats(sum.rays, sum.tracing);
  addMachine(json, options, sum.last);
  json["fps"] = options.fps;
  json["frames"] = sum.frames;
  return dump(json);
}

namespace {
// Counts the Scripts in the world and in the bodies of its prototypes, by protocol.
std::map<std::string, std::pair<uint64_t, uint64_t>> scriptsByProtocol(const WorldCounts& counts) {
  std::map<std::string, std::pair<uint64_t, uint64_t>> all;
  for (const auto& [protocol, count] : counts.scripts) all[protocol].first = count;
  for (const auto& [protocol, count] : counts.declaredScripts) all[protocol].second = count;
  return all;
}
} // namespace

std::string listViewpoints(const std::vector<xvrml::ViewpointInfo>& viewpoints, bool json) {
  if (json) return dump(viewpointsJson(viewpoints));
  std::string text;
  for (size_t i = 0; i < viewpoints.size(); ++i)
    text += fmt::format("{}\t{}\t{}\n", i, viewpoints[i].name.empty() ? "-" : viewpoints[i].name,
                        oneLine(viewpoints[i].description));
  return text;
}

namespace {

Json headJson(const xvrml::FileHead& head) {
  Json json = {{"encoding", encodingName(head.version.encoding)},
               {"version", fmt::format("{}.{}", head.version.major, head.version.minor)},
               {"profile", head.profile}};
  json["components"] = json["units"] = json["meta"] = Json::array();
  for (const auto& one : head.components)
    json["components"].push_back({{"name", one.name}, {"level", one.level}});
  for (const auto& one : head.units)
    json["units"].push_back(
        {{"category", one.category}, {"name", one.name}, {"factor", one.factor}});
  for (const auto& one : head.meta)
    json["meta"].push_back({{"name", one.name}, {"content", one.content}});
  return json;
}

} // namespace

std::string describeWorld(const xvrml::World& world,
                          const std::vector<xvrml::ViewpointInfo>& viewpoints,
                          const xvrml::Bounds& bounds, const UpAxis& up,
                          const std::string& scriptPath, bool json) {
  const WorldCounts counts = countWorld(world);
  if (json) {
    Json all = {{"path", world.path},
                {"file", headJson(world.head)},
                {"nodes", world.nodeCount},
                {"types", Json(counts.types)},
                {"routes", counts.routes}};
    all["prototypes"] = counts.prototypes;
    all["scripts"] = Json::array();
    for (const auto& [protocol, count] : scriptsByProtocol(counts))
      all["scripts"].push_back({{"protocol", protocol},
                                {"count", count.first},
                                {"declared", count.second},
                                {"engine", xvrml::hasScriptEngine(protocol, scriptPath)}});
    all["names"] = counts.names;
    all["viewpoints"] = viewpointsJson(viewpoints);
    all["bounds"] = nullptr;
    if (!bounds.empty)
      all["bounds"] = {{"minimum", Json(bounds.minimum)}, {"maximum", Json(bounds.maximum)}};
    all["up"] = {{"axis", up.axis}, {"reason", up.reason}};
    all["errors"] = world.diagnostics.errors();
    all["warnings"] = world.diagnostics.warnings();
    return dump(all);
  }
  std::string text = fmt::format("world       {}\n{}", world.path, headText(world.head));
  text += fmt::format("nodes       {}\nroutes      {}\nprototypes  {}\nviewpoints  {}\n",
                      world.nodeCount, counts.routes, counts.prototypes.size(), viewpoints.size());
  if (bounds.empty)
    text += "bounds      nothing to see\n";
  else
    text += fmt::format("bounds      {:.6g} {:.6g} {:.6g}  to  {:.6g} {:.6g} {:.6g}\n",
                        bounds.minimum[0], bounds.minimum[1], bounds.minimum[2], bounds.maximum[0],
                        bounds.maximum[1], bounds.maximum[2]);
  if (!up.reason.empty()) text += fmt::format("up          {}: {}\n", up.axis, up.reason);
  for (const auto& [protocol, count] : scriptsByProtocol(counts))
    text += fmt::format("scripts     {} {}{}: {}\n", count.first, protocol,
                        count.second ? fmt::format(", {} in prototypes", count.second) : "",
                        xvrml::hasScriptEngine(protocol, scriptPath) ? "an engine is installed"
                                                                     : "no engine is installed");
  text += fmt::format("problems    {}, {}\n", counted(world.diagnostics.errors(), "error"),
                      counted(world.diagnostics.warnings(), "warning"));
  for (const auto& [type, count] : counts.types) text += fmt::format("  {:>8}  {}\n", count, type);
  return text;
}

} // namespace vv
