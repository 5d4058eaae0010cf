// editor_support.h: A world in a file of its own, with the editor of a session.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "edit/edit_model.h"
#include "xvrml/browser.h"
#include "xvrml/world.h"

namespace editor_test {

// A viewer at (0, 0, 10) who looks along -z.
inline vv::EditView front(double aspect = 1) {
  vv::EditView view;
  const double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 10, 1};
  std::copy(matrix, matrix + 16, view.camera.matrix);
  view.aspect = aspect;
  return view;
}

// The file is removed with this object.
struct EditedWorld {
  explicit EditedWorld(const std::string& text, const std::string& suffix = "wrl")
      : path(testing::TempDir() + "editor_" +
             testing::UnitTest::GetInstance()->current_test_info()->name() + "." + suffix),
        browser(load(path, text)), editor(browser) {}
  ~EditedWorld() { std::filesystem::remove(path); }

  static std::unique_ptr<xvrml::World> load(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return xvrml::loadWorld(path);
  }
  xvrml::NodeRef node(const char* name) { return browser.node(name); }

  const std::string path;
  xvrml::Browser browser;
  vv::WorldEditor editor;
};

} // namespace editor_test
