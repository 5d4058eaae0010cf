#include "cluster_report.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "describe.h"
#include "libpicture/worker_facts.h"
#include "openrt/sums.h"
#include "shortage.h"

namespace vv {

namespace {

std::string bytesText(uint64_t bytes) {
  if (bytes < 10'000) return fmt::format("{} B", bytes);
  if (bytes < 10'000'000) return fmt::format("{:.0f} kB", double(bytes) * 1e-3);
  return fmt::format("{:.0f} MB", double(bytes) * 1e-6);
}

template <class Number> std::string numberText(picture::FactUnit unit, Number number) {
  switch (unit) {
  case picture::FactUnit::million: return fmt::format("{:.1f}", double(number) * 1e-6);
  case picture::FactUnit::bytes: return bytesText(uint64_t(number));
  case picture::FactUnit::milliseconds: return fmt::format("{:.1f} ms", double(number) * 1e3);
  case picture::FactUnit::seconds: return fmt::format("{:.1f} s", double(number));
  case picture::FactUnit::none: break;
  }
  if constexpr (std::is_floating_point_v<Number>) return fmt::format("{:.1f}", number);
  return fmt::format("{}", number);
}

std::string headings() {
  std::string line = fmt::format("{:<24}", "machine");
  picture::forEachWorkerFact([&](const picture::WorkerFact& fact, auto) {
    if (*fact.heading) line += fmt::format(" {:>{}}", fact.heading, fact.width);
  });
  return line;
}

std::string lineOf(const std::string& name, const RTworker& w) {
  const bool here = picture::isHere(w);
  std::string line = fmt::format("{:<24}", name), notes;
  picture::forEachWorkerFact([&](const picture::WorkerFact& fact, auto get) {
    const auto value = std::invoke(get, w);
    if constexpr (std::is_arithmetic_v<decltype(value)>) {
      const std::string text = numberText(fact.unit, value);
      if (*fact.heading)
        line += fmt::format(" {:>{}}", here && fact.ofLink ? "" : text, fact.width);
      if (*fact.note && value != 0) notes += fmt::format("  {} {}", text, fact.note);
    }
  });
  if (here) return line;
  return line + notes + (w.alive ? "" : "  gone");
}

} // namespace

void joinCluster(Options& options) {
  if (!options.cluster.used()) return;
  picture::RenderSettings context = options.render;
  try {
    options.render.cluster = std::make_shared<picture::Cluster>(options.cluster, context);
  } catch (const picture::RenderError& error) {
    if (error.code == RT_OUT_OF_MEMORY) throw;
    const std::string why = error.what();
    const picture::ClusterSettings& c = options.cluster;
    const std::string hosts = c.workers.starts_with('@') ? c.workers.substr(1) : "";
    bool isFile = false; // the message is about a file, not about the command line
    for (const std::string& file : {c.key, c.allow, hosts})
      isFile |= !file.empty() && why.find(file) != why.npos;
    throw Failure{isFile ? exitInput : exitUsage, why};
  }
}

std::string workersText(const std::vector<RTworker>& workers) {
  std::set<std::string_view> names; // a worker that has reconnected is listed twice
  size_t alive = 0;
  for (const RTworker& worker : workers) {
    if (picture::isHere(worker)) continue;
    names.insert(worker.name);
    alive += worker.alive != 0;
  }
  const size_t known = std::max(names.size(), alive);
  if (known == 0) return "no worker yet";
  if (alive < known) return fmt::format("{} of {} worker{}", alive, known, known == 1 ? "" : "s");
  return fmt::format("{} worker{}", alive, alive == 1 ? "" : "s");
}

std::string workersText(const picture::Cluster* cluster) {
  return cluster ? workersText(cluster->workers()) : "";
}

std::vector<std::string> clusterMessageLines(const std::vector<picture::ClusterMessage>& notes,
                                             bool verbose, bool quiet) {
  std::vector<std::string> lines;
  for (const picture::ClusterMessage& note : notes) {
    if (note.level < (quiet ? 3 : verbose ? 1 : 2)) continue;
    const char* kind = note.level >= 3 ? "error: " : note.level == 2 ? "warning: " : "";
    lines.push_back(fmt::format("vv: {}{}", kind, oneLine(note.text)));
  }
  return lines;
}

std::vector<std::string> clusterLines(const picture::RenderResult& result) {
  if (result.workers.empty()) return {};
  const RTstats& s = result.stats;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("vv: cluster: {}; {} of {} jobs done by workers, {} handed out "
                              "again, {} done twice, {} sent, {} received",
                              workersText(result.workers), s.cluster.tilesRemote,
                              s.cluster.tilesRemote + s.cluster.tilesLocal, s.cluster.reissued,
                              s.cluster.duplicates, bytesText(s.cluster.bytesSent),
                              bytesText(s.cluster.bytesReceived)));
  lines.push_back("  " + headings());
  for (const RTworker& worker : result.workers)
    lines.push_back(
        "  " + lineOf(picture::isHere(worker) ? "this process" : oneLine(worker.name), worker));
  return lines;
}

} // namespace vv
