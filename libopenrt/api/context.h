// context.h: everything behind one RTcontext. Used on the application's thread; rtCancel and
// rtProgress reach the backend from any thread under backendMutex_, and the log sink is called by
// render threads.
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

// Where the library's messages go; may be changed while render threads are talking.
class LogSink {
 public:
  void set(RTlogCallback callback, void* user);
  static void forward(int level, const char* message, void* sink); // an RTlogCallback

 private:
  std::recursive_mutex mutex_; // the callback may set another one
  RTlogCallback callback_ = nullptr;
  void* user_ = nullptr;
};

// What rtParameterPointer said: values for geometry whose shader is of a class.
struct ParameterArray {
  RTid shaderClass = 0;
  ParameterSource from;
};

// The object being defined.
struct Definition {
  RTid object = 0;
  ObjectBuilder builder;
  std::vector<RTid> children;
};

class Context {
 public:
  explicit Context(const ContextConfig& config);
  // For tests: renders with a backend of theirs.
  Context(const ContextConfig& config, std::unique_ptr<Backend> backend);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  // Frees everything; the context answers no call afterwards. Returns why a recording is not whole;
  // null where all is well.
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
  bool cull = false, clockwise = false;
  VertexState attributes; // outside definitions, forgotten by rtBeginObject
  AttributeSource vertexArray, normalArray, texCoordArray, colorArray;
  std::vector<ParameterArray> parameterArrays;

  Definition& openDefinition();
  VertexState& currentAttributes() { return definition ? definition->builder.current : attributes; }
  std::vector<RTid>* openChildren() { return definition ? &definition->children : nullptr; }
  void requireOutsideList() const;
  void requireOutsideDefinition() const;
  // What a primitive of this mode latches now; RT_INVALID_OPERATION if the bound shader is no
  // surface shader.
  GeometryState latch(edit::Primitive primitive);
  // The stock camera class's shader, made when it is first asked for.
  RTid stockCamera(const char* className, RTid& cached);
  const RtsClass& findClass(std::string_view className, std::string_view library) const;
  // Loads the libraries anew whose files have changed; returns how many. A failure is recorded and
  // does not keep the others from it.
  int reloadShaders(const char* function);

  // Frames.
  void swapBuffers();
  bool finishFrame();
  void render();
  void cancel();
  float progress();
  bool snapshot(RTenum channel, std::span<float> out);
  std::vector<RTworker> workers(); // [any]
  const edit::FrameSettingsT& finishedFrame() const;
  Backend& backend() { return *backend_; }
  bool everCommitted() const { return everCommitted_; }
  uint64_t finishedNumber() const { return finishedNumber_; }
  uint32_t framesInFlight = 1; // that swapBuffers() leaves to a backend that pipelines
  uint64_t degenerate = 0;
  RTid perspectiveCamera = 0, orthographicCamera = 0;

 private:
  void makeBackend(const ContextConfig& config);
  void begin();
  void commit();
  void start();
  void finishOldest();
  bool forgetCancel();
  void giveUpFrames();

  std::unique_ptr<ShaderRegistry> registry_;
  std::unique_ptr<Backend> backend_;
  std::mutex backendMutex_; // cancel and progress against close; cancelled_
  std::vector<std::shared_ptr<const Commit>>
      unsent_;             // made, but the backend could not take them yet
  bool cancelled_ = false; // since the frame being begun was asked for
  bool everCommitted_ = false, open_ = true;
  std::deque<edit::FrameSettingsT> flying_; // of the frames in flight, oldest first
  std::optional<edit::FrameSettingsT> finished_;
  uint64_t started_ = 0, finishedNumber_ = 0;
};

// The context of this thread: raw for speed, kept alive by a handle beside it (life.cpp).
extern constinit thread_local Context* currentContext;

// Makes a context known, current and owned by the table of live contexts. (life.cpp)
RTcontext adoptContext(std::shared_ptr<Context> context);

} // namespace openrt
