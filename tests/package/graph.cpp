// graph.cpp: reads, changes and writes a world with only the installed scene graph.
#include <cstdio>
#include <xvrml/nodes.h>
#include <xvrml/world.h>

int main() {
  auto world = xvrml::loadWorldFromMemory(
      "#VRML V2.0 utf8\nDEF Place Transform { children Shape { geometry Box { } } }\n", "memory");
  auto* place = xvrml::nodeCast<xvrml::nodes::Transform>(world->scope.names.at("Place"));
  if (!place || place->children.size() != 1 || world->diagnostics.errors()) return 1;
  place->translation = {1, 2, 3};
  const std::string text = xvrml::writeWorld(*world);
  const auto again = xvrml::loadWorldFromMemory(text, "again");
  std::string difference;
  if (!xvrml::equalScopes(world->scope, again->scope, &difference)) {
    std::fprintf(stderr, "graph: %s\n", difference.c_str());
    return 1;
  }
  std::puts("graph: as it must be");
  return 0;
}
