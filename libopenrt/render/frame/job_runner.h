// job_runner.h: does jobs of one prepared scene, on one thread.
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
  // False: given up because the flag was set; result is of no use then. What result holds before is
  // overwritten, its memory used again. Throws what shaders and kernels throw, and
  // std::runtime_error where the frame has no such job.
  bool run(const Job& job, const std::atomic<bool>& stop, JobResult& result);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt
