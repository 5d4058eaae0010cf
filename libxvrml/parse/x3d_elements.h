// x3d_elements.h: what the elements of X3D mean, however they are written: the readers of XML and
// JSON call this class, and it calls the sink (ISO/IEC 19776-1 clause 4 and 5). Nothing here is
// recursive. [the thread that loads]
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "parse/x3d_attributes.h"

namespace xvrml {

// Wide because there is one function for each kind of element.
class X3dElements {
 public:
  // isFragment: the text may also be a single node, without X3D and Scene.
  X3dElements(Locator& locator, const Limits& limits, ParseSink& sink, Budget* budget,
              bool isFragment = false);
  // The reader calls these in the order of the file. Names and values need to live only as long as
  // the call lasts.
  void open(const Name& element, Attributes attributes);
  void characters(std::string_view text, const char* at);
  void close();
  // Closes the elements that are open where the file ends, and reports a file without a scene.
  void finish();

 private:
  // Says what an element is. Those that cannot have children are of kind `leaf`.
  enum class Kind : uint8_t {
    file,
    x3d,
    head,
    statements, // Scene and ProtoBody
    node,
    proto,
    interface,
    externProto,
    declaration, // field
    value,       // fieldValue with nodes
    text,        // fieldValue whose value is the text between its tags
    connections, // IS
    leaf
  };
  struct Connection {
    Name field, interfaceName;
  };
  struct Frame {
    Kind kind;
    Name element;
    bool good = true;
    bool hasProgram = false;     // node: the text between its tags is a program
    bool holdsNodes = false;     // declaration: its value is made of nodes
    std::string_view nodesField; // node: the field that its child nodes are in, while it is open
    // node: that field is an MFNode. declaration, value: its type is MFNode.
    bool isList = false;
    bool filled = false; // declaration, value: a node stands in it
    std::vector<Connection> connections;
    std::string source; // Script, text: what stands between its tags
    const char* sourceAt = nullptr;
    Name field; // text: the field and where its value goes
    FieldTarget target;
  };
  using Handler = void (X3dElements::*)(const Name& element, Attributes attributes);

  void push(Kind kind, const Name& element) { frames_.push_back({kind, element}); }
  Frame& top() { return frames_.back(); }
  void skip(Attributes attributes);
  bool isSecondNode(const Name& element);
  void refuse(const Name& element, std::string_view expected, Attributes attributes);
  bool tooDeep(const Name& element, std::string_view what);
  std::string_view keep(std::string_view text);
  bool nameOf(Name& out, const Name& element, Attributes attributes, std::string_view attribute);
  bool checkName(const Name& name);
  bool checkDeclaredName(const Name& name);
  Name canonical(const Name& element);

  void openRoot(const Name& element, Attributes attributes);
  void openInX3d(const Name& element, Attributes attributes);
  void openInHead(const Name& element, Attributes attributes);
  void openInProto(const Name& element, Attributes attributes);
  void openInInterface(const Name& element, Attributes attributes);
  void openStatement(const Name& element, Attributes attributes);
  void openX3d(const Name& element, Attributes attributes);
  void readUnit(const Name& element, Attributes attributes);
  void readComponent(const Name& element, Attributes attributes);
  void route(const Name& element, Attributes attributes);
  void import(const Name& element, Attributes attributes);
  void exportNode(const Name& element, Attributes attributes);
  void openProto(const Name& element, Attributes attributes);
  void openExternProto(const Name& element, Attributes attributes);
  void openDeclaration(const Name& element, Attributes attributes);
  bool readAccess(const Attribute& attribute, Access& access);
  void openFieldValue(const Name& element, Attributes attributes);
  void closeText(Frame& frame);
  void connect(const Name& element, Attributes attributes);

  void openNode(const Name& element, Attributes attributes);
  bool enterField(const Name& type, const Attribute* container, bool use);
  void leaveField();
  void readField(const Name& type, const Attribute& attribute);
  void appendSource(Frame& frame);
  void closeNode(Frame& frame);

  Locator& locator_;
  const Limits& limits_;
  ParseSink& sink_;
  AttributeReader values_;
  const uint64_t nesting_;
  const bool isFragment_;
  uint64_t depth_ = 0; // number of open nodes and prototypes
  std::vector<Frame> frames_;
  // Elements that are open within one that is left out, with it.
  uint64_t skipped_ = 0;
  bool sawScene_ = false, saidText_ = false, saidValueText_ = false;
  std::unordered_set<std::string> kept_; // names that are not bytes of the file
  std::unordered_map<std::string, std::string_view> lowerCase_; // names of elements
};

} // namespace xvrml
