// main.cpp: nodegen, the generator of node code. Reads .node files and writes the requested outputs
// (docs/nodegen.md).
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/lexer.h"
#include "nodegen/writers.h"
#include "option_words.h"
#include "output_written.h"

namespace {

using namespace xvrml::nodegen;

enum ExitCode { success = 0, usage = 2, unreadable = 3, badSpecification = 4, unwritable = 5 };

struct Options {
  std::vector<std::string> specifications, imports;
  std::string output, numbers, reference, stub, skeleton, skeletonFile, plugin;
};

int fail(ExitCode code, const std::string& message) {
  fmt::print(stderr, "nodegen: {}\n", message);
  return code;
}

void describe(CLI::App& app, Options& options) {
  app.description(
      "Writes the code, reference and Python stub of the nodes described in .node files.");
  app.add_option("specification", options.specifications, "files to generate from, in this order")
      ->required();
  app.add_option("--import", options.imports,
                 "a file read for its abstract types alone; may be given several times")
      ->allow_extra_args(false);
  app.add_option("-o,--output", options.output,
                 "folder for xvrml/nodes.h, xvrml/node_renderer.h, nodes_<component>.cpp, "
                 "nodes_list.cpp and nodes_renderer.cpp");
  auto* numbers =
      app.add_option("--numbers", options.numbers,
                     "list of the nodes' numbers (typeIndex); default: in the order of the files");
  app.add_option("--reference", options.reference, "file for the node reference, in Markdown");
  app.add_option("--stub", options.stub, "file for the Python stub of the node classes");
  auto* skeleton = app.add_option("--skeleton", options.skeleton,
                                  "node to write a first source of its behaviour for");
  app.add_option("--skeleton-file", options.skeletonFile,
                 "file for the skeleton, which must not exist; default: <node>.cpp")
      ->needs(skeleton);
  app.add_option("--plugin", options.plugin,
                 "write for a node plug-in of this name: <plugin>_nodes.h, nodes_<component>.cpp "
                 "and <plugin>_plugin.cpp")
      ->excludes(numbers) // nodes of a plug-in are numbered when it is loaded
      ->check([](const std::string& name) {
        const bool good =
            xvrml::isIdentifier(name) &&
            name.find_first_not_of(
                "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") == name.npos;
        return good ? std::string()
                    : "--plugin: a name of letters, digits and _ was expected, not '" + name + "'";
      });
  app.footer("Exit codes: 0 done, 2 wrong use, 3 a file cannot be read, 4 a specification is "
             "wrong, 5 a file cannot be written.");
}

bool holds(const std::filesystem::path& path, const std::string& text) {
  std::ifstream stream(path, std::ios::binary);
  return stream && std::string(std::istreambuf_iterator<char>(stream), {}) == text;
}

// Writes a file if its content changes. The text goes to a temporary file that is then renamed,
// because a half-written file would be compiled. An unchanged file is left alone, so that nothing
// is rebuilt.
bool writeFile(const std::filesystem::path& path, const std::string& text) {
  if (holds(path, text)) return true;
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  const std::filesystem::path part = path.string() + ".part";
  {
    std::ofstream stream(part, std::ios::binary);
    stream << text;
    stream.close();
    if (stream) std::filesystem::rename(part, path, error);
    if (stream && !error) return true;
  }
  std::filesystem::remove(part, error);
  return false;
}

bool writeCode(const Model& model, const std::filesystem::path& folder, const std::string& plugin) {
  bool good = plugin.empty()
                  ? writeFile(folder / "xvrml" / "nodes.h", writeHeader(model, plugin)) &&
                        writeFile(folder / "xvrml" / "node_renderer.h", writeRenderer(model)) &&
                        writeFile(folder / "nodes_list.cpp", writeList(model)) &&
                        writeFile(folder / "nodes_renderer.cpp", writeRendererCalls(model))
                  : writeFile(folder / (plugin + "_nodes.h"), writeHeader(model, plugin)) &&
                        writeFile(folder / (plugin + "_plugin.cpp"), writePlugin(model, plugin));
  for (const Component& component : model.components) {
    if (component.imported) continue;
    good = good && writeFile(folder / fmt::format("nodes_{}.cpp", component.name),
                             writeTables(component, plugin));
  }
  return good;
}

int writeSkeletonFile(const Model& model, const Options& options) {
  const TypeSpec* type = model.find(options.skeleton);
  if (!type || type->isAbstract)
    return fail(usage, fmt::format("--skeleton: there is no node {}", options.skeleton));
  const std::string path =
      options.skeletonFile.empty() ? options.skeleton + ".cpp" : options.skeletonFile;
  if (std::filesystem::exists(path))
    return fail(unwritable, fmt::format("{} exists: a skeleton is written once", path));
  return writeFile(path, writeSkeleton(*type, options.plugin))
             ? success
             : fail(unwritable, fmt::format("cannot write {}", path));
}

// The library knows only the containers of its own types.
void refuseContainers(Model& model) {
  for (const Component& component : model.components)
    for (const TypeSpec& type : component.types)
      if (!component.imported && !type.container.empty())
        model.error(type.source, fmt::format("{} names a container: the nodes of a plug-in have "
                                             "that of their abstract types in the library",
                                             type.name));
}

int run(const Options& options) {
  Model model;
  const auto readAll = [&model](const std::vector<std::string>& paths, bool imported) {
    for (const std::string& path : paths) {
      if (!readSpecification(path, imported, model)) {
        fail(unreadable, fmt::format("cannot read {}", path));
        return false;
      }
    }
    return true;
  };
  if (!readAll(options.imports, true) || !readAll(options.specifications, false)) return unreadable;
  if (model.diagnostics.errors() == 0) check(model);
  if (!options.plugin.empty()) refuseContainers(model);
  if (options.numbers.empty())
    numberInOrder(model);
  else if (model.diagnostics.errors() == 0 && !readNumbers(options.numbers, model))
    return fail(unreadable, fmt::format("cannot read {}", options.numbers));
  for (const xvrml::Diagnostic& diagnostic : model.diagnostics.list())
    fmt::print(stderr, "{}\n", diagnostic.text());
  if (model.diagnostics.errors() > 0) return badSpecification;

  if (!options.output.empty() && !writeCode(model, options.output, options.plugin))
    return fail(unwritable, fmt::format("cannot write into {}", options.output));
  if (!options.reference.empty() && !writeFile(options.reference, writeReference(model)))
    return fail(unwritable, fmt::format("cannot write {}", options.reference));
  if (!options.stub.empty() && !writeFile(options.stub, writeStub(model)))
    return fail(unwritable, fmt::format("cannot write {}", options.stub));
  return options.skeleton.empty() ? success : writeSkeletonFile(model, options);
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("", "nodegen");
  describe(app, options);
  try {
    app.parse(optionWords(argc, argv, app));
    return run(options);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return usage;
    return outputWritten() ? int(success) : fail(unwritable, "cannot write standard output");
  } catch (const std::exception& error) { return fail(unwritable, error.what()); }
}
