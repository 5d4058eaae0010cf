// script.cpp: what the script engine of Python (plugins/script/python) takes from this module, so
// that a Script sees the same Node objects as a program: functions whose names begin with _script_.
// The engine hands over addresses that its host gave it
// (`object` of xvrml/xscript.h). Called with the GIL held.
#include <unordered_map>

#include "objects.h"

using namespace xvrml;

namespace {

// The world as a Script sees it. It does not hold the browser: the browser holds the Script, which
// keeps nodes.
struct ScriptWorld : WorldObject {
  Browser* scripted;
  const bool
      foreign; // the browser is no object of this module: nobody here knows when it may be changed
  ScriptWorld(Browser* browser, LocksPtr known) : scripted(browser), foreign(!known) {
    if (known) locks = std::move(known);
  }
  World& graph() override {
    if (!scripted) throw py::value_error("the Script that was given this node has ended");
    return scripted->world();
  }
  Browser* browser() override { return scripted; }
  bool loose() const override { return false; }
  const char* frozen() const override {
    return !scripted ? "the Script that was given this node has ended"
           : foreign ? "only the functions of a Script can change nodes here, on the thread on "
                       "which they are called"
                     : nullptr;
  }
  std::shared_ptr<picture::Renderer> renderer(const picture::RenderSettings&,
                                              picture::Watch) override {
    throw picture::RenderError("a Script cannot render");
  }
};

auto& worlds() {
  static auto& all = *new std::unordered_map<const Browser*, std::shared_ptr<ScriptWorld>>();
  return all;
}
thread_local LocksPtr making;

// Of the browsers of this module. One may end on a thread that does not have the GIL.
class AllLocks {
 public:
  LocksPtr find(const Browser* browser) {
    const std::scoped_lock lock(guard_);
    const auto found = all_.find(browser);
    return found != all_.end() ? found->second : making;
  }
  void set(const Browser* browser, LocksPtr locks) {
    const std::scoped_lock lock(guard_);
    if (locks)
      all_[browser] = std::move(locks);
    else
      all_.erase(browser);
  }

 private:
  std::mutex guard_;
  std::unordered_map<const Browser*, LocksPtr> all_;
};
AllLocks& allLocks() {
  static auto& all = *new AllLocks();
  return all;
}

// handler(browser, node, field, value) -> whether a Script is running there; owned by the module
// for the life of the interpreter.
PyObject* assignHandler = nullptr;

py::object wrap(uintptr_t browserAddress, uintptr_t nodeAddress) {
  if (!nodeAddress) return py::none();
  auto* browser = reinterpret_cast<Browser*>(browserAddress);
  std::shared_ptr<ScriptWorld>& world = worlds()[browser];
  if (!world) world = std::make_shared<ScriptWorld>(browser, allLocks().find(browser));
  return asNode(world, reinterpret_cast<Node*>(nodeAddress));
}

uintptr_t address(const NodeObject& node, uintptr_t browserAddress) {
  if (node.world()->browser() != reinterpret_cast<Browser*>(browserAddress))
    throw py::value_error("a node of the world that the Script is in expected");
  return reinterpret_cast<uintptr_t>(node.node.get());
}

// No Script of the browser is left: nodes that somebody has kept can be read and no longer changed.
void end(uintptr_t browserAddress) {
  const auto found = worlds().find(reinterpret_cast<const Browser*>(browserAddress));
  if (found == worlds().end()) return;
  found->second->scripted = nullptr;
  worlds().erase(found);
}

} // namespace

void scriptsLock(const Browser* browser, LocksPtr locks) {
  allLocks().set(browser, std::move(locks));
}

MakingBrowser::MakingBrowser(LocksPtr locks) { making = std::move(locks); }
MakingBrowser::~MakingBrowser() { making.reset(); }

bool scriptAssigns(const NodeObject& node, const std::string& field, const py::handle& value) {
  if (!assignHandler) return false;
  return py::reinterpret_borrow<py::object>(assignHandler)(
             reinterpret_cast<uintptr_t>(node.world()->browser()),
             reinterpret_cast<uintptr_t>(node.node.get()), field, value)
      .cast<bool>();
}

void defineScripts(py::module_& module) {
  module.def("_script_node", wrap);
  module.def("_script_address", address);
  module.def("_script_end", end);
  module.def("_script_assign", [](const py::object& handler) {
    Py_XDECREF(assignHandler);
    assignHandler = handler.is_none() ? nullptr : handler.inc_ref().ptr();
  });
}
