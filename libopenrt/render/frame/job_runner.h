// job_runner.h: executes jobs of one prepared scene on one thread.
#pragma once

#include <atomic>
#include <memory>

#include "render/frame/job.h"
#include "render/render_scene.h"

namespace openrt {

struct FrameFacts;
FrameFacts factsOf(const RenderScene& scene);

class JobRunner {
 public:
  explicit JobRunner(std::shared_ptr<const RenderScene> scene);
  ~JobRunner();
  // Executes a job. Returns false if it was given up because `stop` was set; the result must then
  // be discarded. Overwrites `result` and reuses its memory. Throws what shaders and kernels throw,
  // and std::runtime_error if the frame has no such job.
  bool run(const Job& job, const std::atomic<bool>& stop, JobResult& result);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt
