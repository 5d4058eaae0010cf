// context.h: Holds the state of one RTcontext: scene, bound state, backend and frames. Used on the
// application's thread. Only rtCancel, rtProgress, rtSnapshot and rtGetWorkers use the backend from
// any thread, under backendMutex_; the log sink is called by render threads.
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "api/config.h"
#include "api/errors.h"
#include "api/geometry/matrix_stack.h"
#include "api/geometry/object_builder.h"
#include "api/scene_state.h"
#include "backend/backend.h"
#include "shading/registry.h"

namespace openrt {

// Passes the library's messages to the application's log callback. set() may be called while render
// threads log. [any thread]
class LogSink {
 public:
  void set(RTlogCallback callback, void* user);
  static void forward(int level, const char* message, void* sink); // an RTlogCallback

 private:
  std::recursive_mutex mutex_; // recursive, because the callback may call set()
  RTlogCallback callback_ = nullptr;
  void* user_ = nullptr;
};

// An array set by rtParameterPointer: values for geometry whose shader is of this class.
struct ParameterArray {
  RTid shaderClass = 0;
  ParameterSource from;
};

// The object between rtBeginObject and rtEndObject.
struct Definition {
  RTid object = 0;
  ObjectBuilder builder;
  std::vector<RTid> children;
  ArrayPtr formerIndices; // indices of the tree of a mesh that deforms
};

class Context {
 public:
  explicit Context(const ContextConfig& config);
  // For tests: renders with the given backend.
  Context(const ContextConfig& config, std::unique_ptr<Backend> backend);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  // Frees everything; afterwards every call fails. Returns the error if a recording is incomplete,
  // else null.
  std::exception_ptr close() noexcept;
  bool open() const { return open_; }

  ErrorState errors;
  LogSink log;
  MatrixStack matrices;
  SceneState scene;
  std::optional<Definition> definition;

  // Bound state.
  RTid boundShader = 0, boundTexture = 0;
  uint32_t name = 0;
  float lineWidth = 1, pointSize = 1;
  Stipple stipple;
  edit::TexGen texGen = edit::TexGen::Off;
  bool cull = false, clockwise = false;
  VertexState attributes; // current attributes outside definitions, which do not inherit them
  AttributeSource vertexArray, normalArray, texCoordArray, colorArray, fogCoordArray;
  std::vector<ParameterArray> parameterArrays;

  Definition& openDefinition();
  VertexState& currentAttributes() { return definition ? definition->builder.current : attributes; }
  std::vector<RTid>* openChildren() { return definition ? &definition->children : nullptr; }
  void requireOutsideList() const;
  void requireOutsideDefinition() const;
  // Returns the current state for a primitive. Throws RT_INVALID_OPERATION if the bound shader is
  // not a surface shader.
  GeometryState latch(edit::Primitive primitive);
  // Returns the shader of a stock camera class; creates it on the first call.
  RTid stockCamera(const char* className, RTid& cached);
  const RtsClass& findClass(std::string_view className, std::string_view library) const;
  // Reloads the shader libraries whose files have changed and returns their number. A failure is
  // recorded as an error; the other libraries are reloaded all the same.
  int reloadShaders(const char* function);

  // Frames.
  void swapBuffers();
  bool finishFrame();
  void render();
  void cancel();
  float progress();
  bool snapshot(RTenum channel, std::span<float> out);
  std::vector<RTworker> workers(); // [any thread]
  void keepSums(bool keep);
  void continueFrom(std::shared_ptr<const FrameSums> sums);
  std::shared_ptr<FrameSums> sums(); // [any thread]
  const edit::FrameSettingsT& finishedFrame() const;
  Backend& backend() { return *backend_; }
  bool everCommitted() const { return everCommitted_; }
  uint64_t finishedFrameNumber() const { return finishedFrameNumber_; }
  uint32_t framesInFlight =
      1;               // frames that swapBuffers() leaves in flight if the backend pipelines
  double patience = 0; // RT_PATIENCE
  uint64_t degenerate = 0;
  RTid perspectiveCamera = 0, orthographicCamera = 0;

 private:
  void makeBackend(const ContextConfig& config);
  void begin();
  void commit();
  void start();
  void finishOldest();
  bool takeCancelRequest();
  void abandonFrames();

  std::unique_ptr<ShaderRegistry> registry_;
  std::unique_ptr<Backend> backend_;
  // Guards backend_ against close() during calls from other threads, and cancelled_.
  std::mutex backendMutex_;
  // Commits that the backend has not accepted yet.
  std::vector<std::shared_ptr<const Commit>> unsent_;
  bool keepsSums_ = false;
  SceneDigest digest_; // covers all commits, if sums are kept
  std::shared_ptr<const FrameSums> continueFrom_;
  bool cancelled_ = false; // cancel() was called since the start of the current frame was requested
  bool everCommitted_ = false, open_ = true;
  std::deque<edit::FrameSettingsT> inFlight_; // settings of the frames in flight, oldest first
  std::optional<edit::FrameSettingsT> finished_;
  uint64_t started_ = 0, finishedFrameNumber_ = 0;
};

// The current context of this thread: a raw pointer for speed; a handle beside it keeps the context
// alive (life.cpp).
extern constinit thread_local Context* currentContext;

// Adds a context to the table of live contexts, which owns it, and makes it current (life.cpp).
RTcontext adoptContext(std::shared_ptr<Context> context);
// Returns a live context; null if the handle is none (life.cpp). [any thread]
std::shared_ptr<Context> findContext(RTcontext handle);

} // namespace openrt
