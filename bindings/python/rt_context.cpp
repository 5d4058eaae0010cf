// rt_context.cpp: Implements the contexts of xvrml.rt: lifetime, errors, matrices.
#include "numbers.h"
#include "objects.h"
#include "rt_objects.h"

namespace {

PyObject* rtError = nullptr; // owned by the module for the life of the interpreter

[[noreturn]] void raise(RTenum code, const std::string& text) {
  PyObject* type = code == RT_INVALID_VALUE       ? PyExc_ValueError
                   : code == RT_INVALID_PARAMETER ? PyExc_ValueError
                   : code == RT_OUT_OF_MEMORY     ? PyExc_MemoryError
                   : code == RT_IO_ERROR          ? PyExc_OSError
                                                  : rtError;
  PyErr_SetString(type, text.c_str());
  throw py::error_already_set();
}

} // namespace

RtContext::RtContext(const std::string& config) {
  RTenum code = RT_NO_ERROR;
  std::string text;
  {
    const ReleaseGil release;
    const RTcontext before = rtGetCurrent();
    handle = rtNewContext(config.c_str());
    if (!handle) {
      code = rtGetError();
      text = rtGetErrorMessage();
    }
    rtMakeCurrent(before);
  }
  if (!handle) raise(code, text);
}

RtContext::~RtContext() {
  if (!handle) return;
  const ReleaseGil release;
  rtDeleteContext(handle);
}

void RtContext::close() {
  if (!handle) return;
  if (drawing && owner == std::this_thread::get_id())
    throw std::runtime_error("the context cannot be closed while a picture of it is made");
  RTenum code = RT_NO_ERROR;
  std::string text;
  {
    const ReleaseGil release;
    const std::scoped_lock lock(mutex);
    const RTcontext before = rtGetCurrent();
    rtMakeCurrent(nullptr); // so that only errors of this thread are seen
    rtGetError();
    rtDeleteContext(std::exchange(handle, nullptr));
    if ((code = rtGetError()) != RT_NO_ERROR) text = rtGetErrorMessage();
    rtMakeCurrent(before);
  }
  if (code != RT_NO_ERROR) raise(code, text);
}

CurrentContext::CurrentContext(const RtContextPtr& context, bool edits)
    : context_(context), before_(rtGetCurrent()) {
  if (context->drawing && context->owner == std::this_thread::get_id())
    throw std::runtime_error("the context cannot be used while a picture of it is made");
  {
    const ReleaseGil release;
    lock_ = std::unique_lock(context->mutex);
  }
  if (!context->handle) throw std::runtime_error("the context is closed");
  rtMakeCurrent(context->handle);
  context->dirty |= edits;
}

CurrentContext::~CurrentContext() {
  rtGetError(); // clears the error of an abandoned call
  rtMakeCurrent(before_);
}

void CurrentContext::check() const {
  if (const RTenum code = rtGetError(); code != RT_NO_ERROR) raise(code, rtGetErrorMessage());
}

void CurrentContext::commit() const {
  if (!context_->dirty) return;
  {
    const ReleaseGil release;
    rtFrameBuffer(1, 1, RT_DEPTH); // without light, so that no lamps are prepared for it
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtQualityf(RT_TARGET_ERROR, 0);
    rtQualityf(RT_TIME_LIMIT, 0);
    rtRender();
  }
  check();
  context_->dirty = false;
}

std::array<double, 16> rtMatrix(const py::object& rows, const std::string& name) {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (rows.is_none()) return m;
  const py::array_t<double, py::array::c_style | py::array::forcecast> given(
      numberArray(rows, name, "a 4x4 matrix"));
  if (given.ndim() != 2 || given.shape(0) != 4 || given.shape(1) != 4)
    throw py::value_error(name + ": a 4x4 matrix expected, not of shape " +
                          fromText(py::str(given.attr("shape"))));
  for (size_t i = 0; i < 16; ++i) m[i] = given.at(py::ssize_t(i % 4), py::ssize_t(i / 4));
  return m;
}

void defineRt(py::module_& parent) {
  py::module_ module = parent.def_submodule("rt", "OpenRT contexts; use xvrml.rt.");
  rtError = PyErr_NewExceptionWithDoc("xvrml.rt.Error", "Raised if OpenRT refuses a call.",
                                      PyExc_RuntimeError, nullptr);
  if (!rtError) throw py::error_already_set();
  module.add_object("Error", rtError);
  py::class_<RtContext, RtContextPtr> context(module, "Context",
                                              "An OpenRT context: a scene and its renderer.");
  context
      .def(py::init([](int threads, const std::string& config) {
             if (threads < 0 || threads > 1024)
               throw py::value_error("threads: 0 to 1024 expected");
             return std::make_shared<RtContext>("threads=" + std::to_string(threads) + " " +
                                                config);
           }),
           py::arg("threads") = 0, py::kw_only(), py::arg("config") = "",
           "threads: number of render threads; 0: all that the process may use. config: a "
           "configuration text, as for rtNewContext in C.")
      .def(
          "close", [](RtContext& self) { self.close(); },
          "Deletes the context and everything in it. This also happens when the last reference to "
          "it is gone.")
      .def_property_readonly("closed", [](const RtContext& self) { return !self.handle; })
      .def("__enter__", [](const RtContextPtr& self) { return self; })
      .def("__exit__", [](RtContext& self, const py::args&) { self.close(); });
  defineRtScene(module);
  defineRtQueries(context);
  defineRtRender(context);
}
