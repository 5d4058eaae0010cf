// loader.h: loads a world from its files: parses them, expands prototypes, loads EXTERNPROTOs and
// Inlines. One loader per world, on the thread that called loadWorld.
#pragma once

#include <chrono>
#include <optional>
#include <span>

#include "graph/expander.h"
#include "parse/source.h"

namespace xvrml {

struct InlineNode;

// A text without a header: the version that it follows, and prototypes that it may use without
// declaring them.
struct Fragment {
  FileVersion version;
  std::span<const ProtoPtr> prototypes = {};
};

class Loader {
 public:
  // depth: number of files around the world's own file (fileDepth()).
  Loader(World& world, const LoadOptions& options, uint64_t depth = 0);
  // Loads the world's own file. Throws LoadError if nothing of it can be used.
  // fragment: describes a text without a header; empty: the file has a header.
  // layout: gets where everything stands in the text; null: nowhere.
  void load(const Source& source, const std::string& name,
            const std::optional<Fragment>& fragment = {}, TextLayout* layout = nullptr);
  // Loads the content of an Inline of a world that has already been loaded. enclosing: the files
  // around the Inline, innermost last, one for each enclosing Inline and one for itself.
  // node.content stays null if nothing could be loaded.
  void loadDeferredInline(InlineNode& node, const std::vector<std::string>& enclosing);

 private:
  // Holds a file that Inlines load; `content` is null while it is read.
  struct InlinedFile {
    std::shared_ptr<const Scope> content;
    std::shared_ptr<Exchange> exchange;
    double length = 1;     // metres in its unit of lengths
    uint64_t bytes = 0;    // estimated size in memory
    bool changing = false; // has routes, Scripts or exports, so each Inline needs its own copy
    bool reading = false;
  };

  void parse(const Source& source, const std::shared_ptr<const std::string>& name,
             ParsedFile& file);
  void complete(ParsedFile& file, uint64_t depth);
  void loadInline(InlineNode& node, uint64_t depth);
  bool loadInlineFrom(InlineNode& node, const std::string& path, uint64_t depth,
                      std::string& reason);
  void setContent(InlineNode& node, const InlinedFile& file);
  ProtoPtr resolveExtern(ProtoDeclaration& declaration);
  ProtoPtr findIn(const std::string& path, const std::string& name, std::string& reason);
  void checkInterface(const ProtoDeclaration& wanted, const ProtoDeclaration& found);
  void checkSize(Scope& scope);

  World& world_;
  const uint64_t depth_;
  // Limit for the bytes of Inline files that are read again because each place needs nodes of its
  // own. Copies within copies count at every level, so that files that double at each level soon
  // reach the limit. Further places share their nodes.
  static constexpr uint64_t maxCopiedBytes = uint64_t(512) << 20;
  uint64_t copied_ = 0;
  BudgetPtr budget_;
  LoadState state_;
  Expander expander_;
  std::unordered_map<std::string, InlinedFile> inlined_; // by canonical path
  // Files that EXTERNPROTOs refer to, by canonical path.
  std::unordered_map<std::string, std::unique_ptr<ParsedFile>> libraries_;
  std::unordered_set<const ProtoDeclaration*> tried_;
  uint64_t resolving_ = 0;
  // There are prototype instances or Inlines, so the sizes differ from what the parser added up.
  bool composed_ = false;
};

// Loads a text that needs no header (Browser::createVrmlFromString). name: for messages; relative
// URLs are relative to its folder. budget: the budget of the world that the text becomes part of.
// depth: number of files around the text. Throws LoadError if it is more than one above limit
// inlineDepth.
std::unique_ptr<World> loadFragment(std::string_view text, const std::string& name,
                                    const LoadOptions& options, const BudgetPtr& budget,
                                    uint64_t depth, const Fragment& fragment);
// Does the same as loadWorldFromMemory(), or as loadFragment() with a version, and fills the
// layout, which stays empty for encodings other than VRML97, X3D ClassicVRML and X3D XML.
std::unique_ptr<World> loadWithLayout(std::string_view text, const std::string& name,
                                      const LoadOptions& options, TextLayout& layout,
                                      const std::optional<FileVersion>& fragment = {});
// Does the same as loadWorld() for a world that becomes part of another one.
std::unique_ptr<World> loadWorldInto(const BudgetPtr& budget, const std::string& path,
                                     const LoadOptions& options, uint64_t depth);

} // namespace xvrml
