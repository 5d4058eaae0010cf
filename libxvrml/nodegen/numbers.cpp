// numbers.cpp: gives each node the number that the generated header declares as its typeIndex.
// Programs and node plug-ins have these numbers compiled in, so a list keeps them. Called by main
// once, after check().
#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "nodegen/model.h"

namespace xvrml::nodegen {
namespace {

template <class Function> void eachNode(Model& model, Function function) {
  for (Component& component : model.components) {
    if (component.imported) continue;
    for (TypeSpec& type : component.types)
      if (!type.isAbstract) function(type);
  }
}

// Reads the list line by line and numbers the nodes that it names.
class ListReader {
 public:
  ListReader(std::string path, Model& model) : model_(model) {
    position_.file = std::make_shared<const std::string>(std::move(path));
    position_.column = 1;
    eachNode(model, [this](TypeSpec& type) { nodes_.emplace(type.name, &type); });
  }

  void read(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      ++position_.line;
      if (!line.empty() && line[0] != '#') readLine(line);
    }
    int next = next_;
    eachNode(model_, [&](TypeSpec& type) {
      if (type.number < 0)
        model_.error(type.source, fmt::format("{} has no number: append \"{} {}\" to {}", type.name,
                                              next++, type.name, *position_.file));
    });
  }

 private:
  // line ::= number blank name
  void readLine(const std::string& line) {
    const size_t blank = std::min(line.find(' '), line.size());
    int number = -1;
    const auto [end, error] = std::from_chars(line.data(), line.data() + blank, number);
    if (error != std::errc() || end != line.data() + blank || number != next_)
      return model_.error(position_, fmt::format("number {} was expected, not \"{}\": numbers have "
                                                 "no gaps, and none is used twice",
                                                 next_, line.substr(0, blank)));
    ++next_;
    const std::string name = line.substr(std::min(blank + 1, line.size()));
    const auto found = nodes_.find(name);
    if (found == nodes_.end())
      return model_.error(position_, fmt::format("there is no node \"{}\": older programs have its "
                                                 "number compiled in",
                                                 name));
    if (found->second->number >= 0)
      return model_.error(position_,
                          fmt::format("{} has number {} already", name, found->second->number));
    found->second->number = number;
  }

  Model& model_;
  SourcePosition position_;
  std::map<std::string, TypeSpec*, std::less<>> nodes_;
  int next_ = 0; // number that the next line must have
};

} // namespace

bool readNumbers(const std::string& path, Model& model) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) return false;
  model.texts[path] = text.str();
  ListReader(path, model).read(model.texts[path]);
  return true;
}

void numberInOrder(Model& model) {
  int next = 0;
  eachNode(model, [&](TypeSpec& type) { type.number = next++; });
}

} // namespace xvrml::nodegen
