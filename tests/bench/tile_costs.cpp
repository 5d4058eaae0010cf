// tile_costs.cpp: bench_tile_costs RECORDING [SAMPLES] measures what each tile of a recording's
// last frame costs one thread, in microseconds per sample of a pixel. It writes the file that
// bench_cluster_sim reads (costs=FILE) to standard output. It uses processor time, so the machine
// may be busy with other things.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "backend/local/local.h"
#include "backend/record/reader.h"
#include "render/frame/frame_work.h"
#include "render/frame/job_runner.h"
#include "shading/registry.h"
#include "thread_clock.h"

namespace {

using namespace openrt;

void print(const char* recording, uint32_t samples) {
  constexpr uint32_t edge = 16;
  ShaderRegistry shaders(shaderFolders({}));
  BackendOptions options;
  options.threads = 1;
  options.shaders = &shaders;
  LocalBackend backend(options);
  const auto reader = openRecording(recording, &shaders);
  while (const auto commit = reader->next()) backend.apply(commit);
  auto scene = std::make_shared<RenderScene>(*backend.prepared());
  scene->frame.tile = edge;
  scene->frame.samples = samples;
  scene->frame.progressive = false;
  FrameWork work(scene->frame, FrameFacts{true, false}, 1); // light from lamps belongs to no tile
  JobRunner runner(scene);
  const std::atomic<bool> never{false};
  JobResult result;
  const uint32_t columns = (scene->frame.width + edge - 1) / edge;
  std::printf("# microseconds of a pixel's sample, %ux%u, tiles of %u; bench_tile_costs\n%u %u\n",
              scene->frame.width, scene->frame.height, edge, columns, work.tiles() / columns);
  for (Job job; work.next(job) == FrameWork::Next::job;) {
    const double began = threadSeconds();
    runner.run(job, never, result);
    const double perSample =
        (threadSeconds() - began) / double(work.tile(job.number).pixels() * job.count);
    std::printf("%.2f%c", perSample * 1e6, (job.number + 1) % columns ? ' ' : '\n');
  }
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("bench_tile_costs RECORDING [SAMPLES]\n", stderr);
    return 2;
  }
  try {
    print(argv[1], argc > 2 ? uint32_t(std::strtoul(argv[2], nullptr, 10)) : 4);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_tile_costs: %s\n", e.what());
    return 1;
  }
}
