// text_copier.h: copies the text of a document from a place on, but for the parts that are replaced
// or removed, for routes that have been edited, and for prototypes that must stand further up.
// Internal; one thread at a time.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "edit/document.h"
#include "xvrml/walk.h"

namespace xvrml {

class TextCopier {
 public:
  // lifted: prototypes of the file that are left out where they stand.
  TextCopier(const Document& document, std::vector<const PrototypeText*> lifted);

  // Copies the text up to a byte.
  void copy(const DocumentText& text, size_t end);
  // Leaves a part of the text out, with its line if nothing else stands in it.
  void remove(const DocumentText& text, const TextSpan& span);
  // Copies the text up to the name of a node, and writes the name that it has now. Does nothing if
  // that is the name of the text.
  void replaceName(const DocumentText& text, const TextSpan& span, const Node& node);

  // Returns the prototype of an instance if its text has not been copied yet; else null.
  const PrototypeText* missingFor(const ProtoInstance& instance) const;

  std::string out; // what has been written
  SeenNodes written;
  // Routes that have been copied. Those whose nodes were written behind them cannot stay in their
  // places.
  std::unordered_set<const Route*> copied;
  size_t at = 0; // the first byte of the present text that has not been copied

 private:
  void raw(const DocumentText& text, size_t end);
  void copyRoute(const DocumentText& text, const RouteText& place);

  const Document& document_;
  // By their places in the file.
  std::unordered_map<uint64_t, const Route*> routes_;
  std::unordered_map<uint64_t, const PrototypeText*> prototypes_;
  const std::vector<const PrototypeText*> lifted_;
  std::unordered_set<const PrototypeText*> declared_; // those that have been copied or lifted
};

} // namespace xvrml
