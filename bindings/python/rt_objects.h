// rt_objects.h: Declares the C++ side of the Python module xvrml.rt: an OpenRT context and its
// contents. A context is current on a thread only while a call for it runs there. Calls run one at
// a time; the others wait without the GIL.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "gil.h"
#include "openrt/openrt.h"

namespace py = pybind11;

struct RtContext {
  explicit RtContext(const std::string& config);
  ~RtContext(); // no call is running: each call holds a reference
  void close();
  RTcontext handle = nullptr;
  TrackedMutex<std::mutex> mutex;
  bool dirty = true; // there are edits that no query has seen yet
  // A picture is being rendered for the thread that holds the mutex.
  std::atomic<bool> drawing{false};
  std::thread::id owner; // the thread that holds the mutex
};
using RtContextPtr = std::shared_ptr<RtContext>;

// Makes the context current on this thread for its lifetime. [constructed and destroyed with the
// GIL]
class CurrentContext {
 public:
  explicit CurrentContext(const RtContextPtr& context, bool edits = true);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;
  // Raises the errors that calls have reported since the last check.
  void check() const;
  // Makes edits visible to queries.
  void commit() const;

 private:
  const RtContextPtr context_;
  std::unique_lock<TrackedMutex<std::mutex>> lock_;
  RTcontext before_;
};

struct RtHandle { // an object, instance, shader, light or texture
  RtContextPtr context;
  RTid id = 0;
};
struct RtObject : RtHandle {};
struct RtInstance : RtHandle {};
struct RtTexture : RtHandle {};
struct RtLight : RtHandle {};
struct RtShader : RtHandle {
  RTid shaderClass = 0;
  std::string name;
};

// Converts a 4x4 matrix for column vectors, in mathematical notation; None is the identity. name:
// name of the argument, for messages.
std::array<double, 16> rtMatrix(const py::object& rows, const std::string& name = "matrix");

void defineRtScene(py::module_& module);
void defineRtQueries(py::class_<RtContext, RtContextPtr>& context);
void defineRtRender(py::class_<RtContext, RtContextPtr>& context);
