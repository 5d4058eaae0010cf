// vv_control_line.cpp: reads arbitrary bytes as a line of the control channel. A line gives a
// command, or an error whose answer is JSON again. libFuzzer calls this on one thread.
#include <cstdint>
#include <string_view>

#include "control/command.h"

using namespace vv::control;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const Line line = readLine({reinterpret_cast<const char*>(data), size});
  if (line.command) {
    if (!line.code.empty() || line.command->name.empty()) __builtin_trap();
    return 0;
  }
  if (line.code.empty() || line.message.empty()) __builtin_trap();
  const Json answer = Json::parse(errorAnswer(line.id, line.code, line.message), nullptr, false);
  if (!answer.is_object() || !answer.contains("id") || !answer["error"]["message"].is_string())
    __builtin_trap();
  return 0;
}
