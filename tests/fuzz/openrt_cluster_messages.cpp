// openrt_cluster_messages.cpp: decodes anything that a master or worker may receive: framing,
// headers, edits, chunks of arrays, results of jobs. The input is a sequence of frames, each with
// its length in two bytes; the rest is the last frame.
#include <array>

#include "backend/cluster/messages/messages.h"
#include "backend/record/edits_bytes.h"
#include "backend/record/validator.h"
#include "render/frame/result_codec.h"

namespace {

using namespace openrt;
using namespace openrt::cluster;

Frames framesOf(std::span<const std::byte> data) {
  Frames frames;
  while (data.size() >= 2) {
    const size_t length = std::min(size_t(data[0]) | size_t(data[1]) << 8, data.size() - 2);
    frames.emplace_back(data.begin() + 2, data.begin() + 2 + std::ptrdiff_t(length));
    data = data.subspan(2 + length);
  }
  return frames;
}

// Reads a scene as the worker does.
void take(message::Scene& scene) {
  Commit commit;
  for (const auto& name : scene.arrays)
    if (name.bytes <= 4096) commit.arrays.emplace(name.id, std::make_shared<Array>(name.bytes));
  try {
    unpackEdits(scene.edits, commit.edits);
    CommitValidator(nullptr).check(commit);
  } catch (const std::runtime_error&) {}
}

// Reads a result as the master does, for frames of several kinds.
void take(const message::Result& result) {
  for (const uint32_t channels :
       {uint32_t(RT_RGBA), uint32_t(RT_RGBA | RT_DEPTH | RT_NORMAL | RT_VARIANCE | RT_ERROR)}) {
    edit::FrameSettingsT frame;
    frame.width = 5;
    frame.height = 3;
    frame.samples = 8;
    frame.channels = channels;
    Job job;
    job.count = 8;
    JobResult out;
    decodeResult(frame, job, {0, 0, 5, 3}, result.bytes, out);
    job.kind = Job::Kind::light;
    decodeResult(frame, job, {}, result.bytes, out);
  }
}

// Decodes the data behind the checksums, which a fuzzer cannot guess.
void takeBulk(const std::vector<std::byte>& bytes) {
  message::Result result;
  result.bytes = bytes;
  take(result);
  message::Scene scene;
  scene.arrays = {{10, 16, {}}};
  scene.edits = bytes;
  take(scene);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Frames frames = framesOf(std::as_bytes(std::span(data, size)));
  if (frames.size() > 1) takeBulk(frames[1]);
  Message out;
  if (!decode(std::move(frames), out).empty()) return 0;
  if (auto* scene = std::get_if<message::Scene>(&out.body)) take(*scene);
  if (auto* result = std::get_if<message::Result>(&out.body)) take(*result);
  if (auto* piece = std::get_if<message::Piece>(&out.body);
      piece && piece->bytes <= 1 << 20 && plausible(piece->bytes, piece->stored))
    unpackArray(piece->data, piece->bytes, piece->hash);
  return 0;
}
