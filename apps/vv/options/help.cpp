// help.cpp: The texts of `vv --help`: a short one, those of its topics, and all of it. [main
// thread]
#include "help.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "lower_case.h"
#include "nearest.h"
#include "option_info.h"
#include "values.h"

namespace vv {

namespace {

constexpr size_t indent = 26, width = 100;
constexpr std::string_view exitCodes = "exit codes", everything = "all";

// The options of the short text.
constexpr std::string_view usual[] = {
    "--output", "--size",     "--spp",  "--error",  "--preset", "--from",    "--viewpoint",
    "--fit",    "--exposure", "--time", "--shader", "--check",  "--explain", "--stats"};

// Breaks `text` into lines of at most `columns`; all lines except the first are indented by
// `indent` blanks.
std::string wrapped(std::string_view text, size_t columns) {
  std::string out;
  size_t column = 0;
  for (std::string_view word : split(text, ' ')) {
    if (column && column + 1 + word.size() > columns) {
      out += "\n" + std::string(indent, ' ');
      column = 0;
    }
    if (column) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

std::string describe(const OptionInfo& option, std::string_view text) {
  std::string head = "  ";
  for (std::string_view name : split(option.names, ','))
    head += fmt::format("{}{}", head.size() > 2 ? ", " : "", name);
  if (*option.argument) head += fmt::format(" {}", option.argument);
  const std::string gap = head.size() + 1 < indent ? std::string(indent - head.size(), ' ')
                                                   : "\n" + std::string(indent, ' ');
  return head + gap + wrapped(text, width - indent) + "\n";
}

// Returns the options of a group below its name; all groups if it is empty.
std::string describeGroups(std::string_view wanted) {
  std::string out, group;
  for (const OptionInfo& option : optionTable()) {
    if (!wanted.empty() && wanted != lowerCase(option.group)) continue;
    if (group != option.group) {
      group = option.group;
      out += fmt::format("\n{}\n", group);
    }
    out += describe(option, option.text);
  }
  return out;
}

// Returns the topics: the groups of options, in lower case and in their order.
std::vector<std::string> topics() {
  std::vector<std::string> out;
  for (const OptionInfo& option : optionTable())
    if (const std::string topic = lowerCase(option.group); out.empty() || out.back() != topic)
      out.push_back(topic);
  return out;
}

// Returns "STL .stl, PLY .ply, ...": the encodings of meshes.
std::string meshNames() {
  std::string names;
  for (int i = 0; i < xvrml::encodingCount(); ++i)
    if (const auto encoding = static_cast<xvrml::Encoding>(i); xvrml::isMesh(encoding))
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", encodingName(encoding),
                           meshSuffixes(encoding));
  return names;
}

std::string usage() {
  return "vv: renders worlds in VRML and X3D, and meshes.\n"
         "\n"
         "  vv world.wrl                    opens the world in a window; F1 lists the keys\n"
         "  vv world.wrl -o picture.png     writes a picture from the first viewpoint, or of the "
         "whole world\n"
         "  vv edit world.wrl               opens it with the editor, which keeps the file as it "
         "is "
         "written\n"
         "  vv merge a.exr b.exr -o c.exr   adds pictures of different seeds, written with --sums\n"
         "  vv compare a.exr b.exr          tells whether two pictures differ by more than their "
         "noise\n"
         "  vv film --join f*.png -o f.mp4  makes a film of pictures\n"
         "  vv serve world.wrl              shows the world on a page for browsers; prints its "
         "address\n"
         "\n"
         "FILE is VRML97 or VRML 1.0 (.wrl, .wrz), X3D (.x3d, .x3dv, .x3dj), or a mesh, gzipped or "
         "not\n(" +
         meshNames() + "); - is standard input.\n";
}

std::string describeExitCodes() {
  return "\nExit codes\n"
         "  0    done\n"
         "  1    the picture could not be made or written\n"
         "  2    the command line is wrong\n"
         "  3    unusable input: the world, or another file that the command line names, "
         "cannot be read\n"
         "  4    --check, --strict or --audit found problems; --measure found no sensor or a wrong "
         "one;\n"
         "       vv compare found a difference; --audit-denoise found more doubt than it allows\n"
         "  5    under --strict: a plug-in or a texture is missing\n"
         "  6    fewer workers than --require-workers asks for\n"
         "  7    --time-limit has ended a run with --resume; the same command goes on\n"
         "  75   out of memory or another resource, try again\n"
         "  130  interrupted; what was finished is saved. A second interrupt ends at once. "
         "SIGUSR1 saves and goes on\n";
}

// Returns the first sentence of a text.
std::string_view firstSentence(std::string_view text) {
  const size_t end = text.find(". ");
  return end == text.npos ? text : text.substr(0, end + 1);
}

std::string shortHelp() {
  std::string out = usage() + "\nOften used\n";
  for (const std::string_view name : usual)
    if (const OptionInfo* option = optionCalled(name))
      out += describe(*option, firstSentence(option->text));
  std::string all;
  for (const std::string& topic : topics()) all += topic + ", ";
  all += fmt::format("{}, {}; or an option, such as vv --help --size", exitCodes, everything);
  return fmt::format("{}\nMore\n  {:24}{}\n", out, "vv --help TOPIC", wrapped(all, width - indent));
}

} // namespace

std::string helpText(std::string_view about) {
  if (about.empty()) return shortHelp();
  const std::string topic = lowerCase(about);
  if (topic == everything) return usage() + describeGroups("") + describeExitCodes();
  if (topic == exitCodes || topic == "exit") return describeExitCodes().substr(1);
  if (const std::string group = describeGroups(topic); !group.empty()) return group.substr(1);
  for (const std::string& name : {std::string(about), fmt::format("--{}", about)})
    if (const OptionInfo* option = optionCalled(name)) return describe(*option, option->text);
  std::vector<std::string> known = topics();
  known.insert(known.end(), {std::string(exitCodes), std::string(everything)});
  for (const OptionInfo& option : optionTable())
    for (std::string_view name : split(option.names, ',')) known.emplace_back(name);
  const std::string near = nearest::word(topic, known);
  throw UsageError(fmt::format("--help: there is no topic \"{}\"{}; vv --help lists them", about,
                               near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

} // namespace vv
