#include "window/panel_state.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "libpicture/files/atomic_file.h"
#include "user_folder.h"

namespace vv {

namespace fs = std::filesystem;

std::string panelStateFile() {
  const fs::path state = userFolder("XDG_STATE_HOME", ".local/state");
  return state.empty() ? std::string() : (state / "vv" / "panels").string();
}

PanelWidths readPanelWidths(const std::string& file) {
  constexpr float least = 50, most = 5000;
  constexpr size_t mostBytes = 1024;
  PanelWidths widths;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return widths; // a pipe would block
  std::string text(mostBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), std::streamsize(text.size()));
  text.resize(size_t(stream.gcount()));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    float width = 0;
    if (!(words >> name >> width) || !(width >= least && width <= most)) continue;
    if (name == "outline") widths.outline = width;
    if (name == "sheet") widths.sheet = width;
  }
  return widths;
}

void writePanelWidths(const std::string& file, const PanelWidths& widths) {
  if (file.empty()) return;
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  try {
    picture::writeRegularFile(file, fmt::format("outline {:.0f}\nsheet {:.0f}\n",
                                                double(widths.outline), double(widths.sheet)));
  } catch (const std::runtime_error&) {} // the panels have their usual widths next time
}

} // namespace vv
