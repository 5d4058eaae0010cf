#include "session/read_script.h"

#include "session/input/input_script.h"

namespace vv {

void readScript(Options& options) {
  if (options.inputScript.empty()) return;
  options.script = std::make_shared<InputScript>(readInputScript(options.inputScript));
  if (!options.time && !options.frames && !options.opensWindow())
    options.time = options.script->end;
}

} // namespace vv
