// loader.h: brings a world together from its files: parses, expands prototypes, loads EXTERNPROTOs
// and Inlines. One loader per world, on the thread that called loadWorld.
#pragma once

#include <chrono>

#include "graph/expander.h"
#include "parse/source.h"

namespace xvrml {

struct InlineNode;

class Loader {
 public:
  Loader(World& world, const LoadOptions& options);
  // Throws LoadError if nothing of the file can be used.
  void load(const Source& source, const std::string& name, bool header = true);
  // The content of an Inline of a world that has been loaded. enclosing: the files it is in, the
  // innermost last, as many as Inlines are around it and itself. node.content stays null if there
  // is none.
  void loadLate(InlineNode& node, const std::vector<std::string>& enclosing);

 private:
  // A file that Inlines name. `content` is null while it is being read.
  struct InlinedFile {
    std::shared_ptr<const Scope> content;
    uint64_t bytes = 0;    // rough size in memory
    bool changing = false; // has routes or scripts: each Inline needs its own
    bool reading = false;
  };

  void parse(const Source& source, const std::shared_ptr<const std::string>& name,
             ParsedFile& file);
  void complete(ParsedFile& file, uint64_t depth);
  void loadInline(InlineNode& node, uint64_t depth);
  bool loadInlineFrom(InlineNode& node, const std::string& path, uint64_t depth,
                      std::string& reason);
  ProtoPtr resolveExtern(ProtoDeclaration& declaration);
  ProtoPtr findIn(const std::string& path, const std::string& name, std::string& reason);
  void checkInterface(const ProtoDeclaration& wanted, const ProtoDeclaration& found);
  void checkSize(Scope& scope);

  World& world_;
  // Bytes of Inlines that are read again, because each place needs nodes of its own. Copies within
  // copies count at every level, which ends files that double at each level soon; further places
  // share their nodes.
  static constexpr uint64_t mostCopied = uint64_t(512) << 20;
  uint64_t copied_ = 0;
  BudgetPtr budget_;
  LoadState state_;
  Expander expander_;
  std::unordered_map<std::string, InlinedFile> inlined_; // by canonical path
  std::unordered_map<std::string, std::unique_ptr<ParsedFile>>
      libraries_; // files that EXTERNPROTOs name
  std::unordered_set<const ProtoDeclaration*> tried_;
  uint64_t resolving_ = 0;
  bool composed_ = false; // prototypes or Inlines came in: sizes are not what the parser added up
};

// A text that needs no header (Browser::createVrmlFromString). name: for messages; relative URLs
// are relative to its folder. budget: of the world that the text becomes part of.
std::unique_ptr<World> loadFragment(std::string_view text, const std::string& name,
                                    const LoadOptions& options, const BudgetPtr& budget);
// As loadWorld(), for a world that becomes part of another one.
std::unique_ptr<World> loadWorldInto(const BudgetPtr& budget, const std::string& path,
                                     const LoadOptions& options);

} // namespace xvrml
