// script.cpp: Defines the functions that the script engine of Python (plugins/script/python) calls
// in this module; their names begin with _script_. Scripts thus see the same Node objects as a
// program. The engine passes addresses that its host gave it (`object` of xvrml/xscript.h). [GIL
// held]
#include <unordered_map>

#include "objects.h"

using namespace xvrml;

namespace {

// The world as a Script sees it. It does not own the browser, because the browser owns the Script,
// which keeps nodes.
struct ScriptWorld : WorldObject {
  Browser* scripted;
  // The browser does not belong to this module, so it is unknown when it may be changed.
  const bool foreign;
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
                                              picture::ProgressCallback) override {
    throw picture::RenderError("a Script cannot render");
  }
};

auto& worlds() {
  static auto& all = *new std::unordered_map<const Browser*, std::shared_ptr<ScriptWorld>>();
  return all;
}
thread_local LocksPtr making;

// The locks of all browsers of this module. A browser may end on a thread without the GIL.
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

// handler(browser, node, field, value) returns whether a Script is running there. Owned by the
// module for the life of the interpreter.
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

// Called when the browser's last Script has ended. Nodes that Python still holds become read-only.
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
