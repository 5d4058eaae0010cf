#include "backend/cluster/worker/counts.h"

#include <cstdio>

namespace openrt::cluster {
namespace {

// Writes metrics: a family is begun by its help and type, and has a sample for each set of labels.
class Metrics {
 public:
  void family(const char* name, const char* type, const char* help) {
    name_ = std::string("openrt_worker_") + name;
    text_ += "# HELP " + name_ + " " + help + "\n# TYPE " + name_ + " " + type + "\n";
  }
  void sample(double value, const std::string& labels = {}) {
    char number[40];
    std::snprintf(number, sizeof number, "%.17g", value);
    text_ += name_ + (labels.empty() ? "" : "{" + labels + "}") + " " + number + "\n";
  }
  void one(const char* name, const char* type, const char* help, double value) {
    family(name, type, help);
    sample(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_, name_;
};

// Returns a label. Backslashes, quotes and line ends are escaped, as the format demands.
std::string label(const char* name, const std::string& value) {
  std::string escaped;
  for (const char c : value) {
    if (c == '\\' || c == '"') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return std::string(name) + "=\"" + escaped + "\"";
}

void addBytes(Metrics& m, const WorkerCounts& counts) {
  m.family("received_bytes_total", "counter", "Bytes of messages received.");
  m.sample(double(counts.fromMaster), label("from", "master"));
  m.sample(double(counts.fromWorkers), label("from", "worker"));
  m.family("sent_bytes_total", "counter", "Bytes of messages sent.");
  m.sample(double(counts.toMaster), label("to", "master"));
  m.sample(double(counts.toWorkers), label("to", "worker"));
}

void addArrays(Metrics& m, const WorkerCounts& counts) {
  const std::pair<const char*, const WorkerCounts::Arrays*> places[] = {
      {"memory", &counts.inMemory},
      {"folder", &counts.inFolder},
      {"worker", &counts.sentByWorkers},
      {"master", &counts.sentByMaster}};
  m.family("arrays_total", "counter", "Meshes and textures of scenes, by where they came from.");
  for (const auto& [place, arrays] : places) m.sample(double(arrays->number), label("from", place));
  m.family("array_bytes_total", "counter", "Unpacked bytes of these arrays.");
  for (const auto& [place, arrays] : places) m.sample(double(arrays->bytes), label("from", place));
}

} // namespace

std::string metricsText(const WorkerCounts& counts, const WorkerGauges& gauges,
                        const message::Hello& self) {
  Metrics m;
  m.family("info", "gauge", "Version and ray kernels of the worker.");
  m.sample(1, label("version", self.library) + "," + label("isa", self.isa) + "," +
                  label("kernel", self.kernel));
  m.one("threads", "gauge", "Render threads.", gauges.threads);
  m.one("serving", "gauge", "1 while a master is connected.", gauges.serving);
  m.one("masters_total", "counter", "Masters served.", double(counts.masters));
  m.one("scenes_total", "counter", "Scenes and changes of scenes received.", double(counts.scenes));
  m.one("jobs_total", "counter", "Jobs done.", double(counts.jobs));
  m.one("job_seconds_total", "counter", "Seconds in jobs, summed over threads.", counts.seconds);
  m.family("rays_total", "counter", "Rays traced.");
  m.sample(double(counts.cameraRays), label("kind", "camera"));
  m.sample(double(counts.shadowRays), label("kind", "shadow"));
  m.sample(double(counts.secondaryRays), label("kind", "secondary"));
  addBytes(m, counts);
  addArrays(m, counts);
  m.one("fetches_failed_total", "counter", "Arrays that another worker did not send.",
        double(counts.failedFetches));
  m.one("damaged_files_total", "counter", "Files of the folder with wrong contents.",
        double(gauges.damagedFiles));
  return m.take();
}

} // namespace openrt::cluster
