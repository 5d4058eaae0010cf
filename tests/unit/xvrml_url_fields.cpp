// xvrml_url_fields.cpp: Tests which fields hold URLs. Relative URLs count from the file that they
// stand in, also when prototypes of other folders hand them on (ISO/IEC 14772-1 4.5.3).
#include <cstddef>
#include <set>

#include "unit/xvrml_parser_support.h"
#include "xvrml/node_table.h"
#include "xvrml/set_field.h"

namespace {

using namespace parser_test;

TEST(UrlFields, AreThoseOfTheStandard) {
  std::set<std::string> found;
  for (const NodeType* type : nodeTypes())
    for (const FieldInfo& field : type->fields)
      if (field.holdsUrls) {
        found.insert(type->name + '.' + field.name);
        EXPECT_EQ(field.type, FieldType::MFString) << field.name;
        EXPECT_TRUE(holdsValue(field)) << field.name;
      }
  EXPECT_EQ(found,
            (std::set<std::string>{
                "Anchor.url", "AudioClip.url", "Background.backUrl", "Background.bottomUrl",
                "Background.frontUrl", "Background.leftUrl", "Background.rightUrl",
                "Background.topUrl", "GeoLOD.child1Url", "GeoLOD.child2Url", "GeoLOD.child3Url",
                "GeoLOD.child4Url", "GeoLOD.rootUrl", "ImageCubeMapTexture.url", "ImageTexture.url",
                "ImageTexture3D.url", "Inline.url", "MovieTexture.url", "Script.url"}));
}

// Prototypes in the folder lib/, used by worlds/w.wrl.
class UrlsThroughIs : public testing::Test {
 protected:
  const World& load(const std::string& library, const std::string& text) {
    folder.write("lib/p.wrl", header + library);
    world = loadWorld(folder.write("worlds/w.wrl", header + text));
    EXPECT_EQ(messages(*world), "");
    return *world;
  }
  const Node& drawn(size_t root) const { return *renderedNode(world->scope.roots.at(root).get()); }
  // Returns the file that the first string of the field names, relative to the test's folder.
  std::string file(const Node& node, const std::string& name) const {
    const std::string& url = field<MFString>(node, name).at(0);
    const ResolvedUrl resolved = resolveUrl(url, *node.source.file, {});
    EXPECT_EQ(resolved.error, "") << url;
    return std::filesystem::relative(resolved.path, folder.path("")).string();
  }

  const Folder folder;
  std::unique_ptr<World> world;
};

const std::string pinned = "PROTO Pinned [ field MFString picture \"own.png\" ] { Anchor { url IS "
                           "picture } }\n";

TEST_F(UrlsThroughIs, TheNameOfAPrototypesFieldDoesNotMatter) {
  load(pinned, "EXTERNPROTO Pinned [ field MFString picture ] \"../lib/p.wrl\"\n"
               "Pinned { picture \"mine.png\" } Pinned { }\n");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "lib/own.png");
}

// The URL passes through three prototypes in three folders under three names.
TEST_F(UrlsThroughIs, EachPrototypeOnTheWayIsFollowed) {
  folder.write("deep/q.wrl", header +
                                 "EXTERNPROTO Pinned [ field MFString picture ] \"../lib/p.wrl\"\n"
                                 "PROTO Framed [ field MFString motif \"framed.png\" ] {\n"
                                 "  Pinned { picture IS motif } }\n");
  load(pinned, "EXTERNPROTO Framed [ field MFString motif ] \"../deep/q.wrl\"\n"
               "PROTO Hung [ field MFString what \"hung.png\" ] { Framed { motif IS what } }\n"
               "Hung { what \"mine.png\" } Hung { } Framed { }\n");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "worlds/hung.png");
  EXPECT_EQ(file(drawn(2), "url"), "deep/framed.png");
  ASSERT_TRUE(setField(*world, *world->scope.roots[1], "what", MFString{"set.png"}));
  EXPECT_EQ(file(drawn(1), "url"), "worlds/set.png");
}

// The strings of this field are shown, whatever the field is called.
TEST_F(UrlsThroughIs, AFieldCalledUrlIsOneOnlyIfItIsConnectedToOne) {
  load("PROTO Words [ field MFString url \"own\" ] { Shape { geometry Text { string IS url } } }\n"
       "PROTO Outer [ field MFString url \"outer\" ] { Words { url IS url } }\n",
       "EXTERNPROTO Words [ field MFString url ] \"../lib/p.wrl#Words\"\n"
       "EXTERNPROTO Outer [ field MFString url ] \"../lib/p.wrl#Outer\"\n"
       "Words { url \"mine\" } Outer { url \"mine/too\" }\n");
  for (const auto& [root, shown] : {std::pair(0, "mine"), std::pair(1, "mine/too")}) {
    const auto& shape = dynamic_cast<const nodes::Shape&>(drawn(size_t(root)));
    EXPECT_EQ(nodeCast<nodes::Text>(shape.geometry)->string, (MFString{shown}));
  }
}

TEST_F(UrlsThroughIs, AnUnconnectedFieldCalledUrlKeepsItsStrings) {
  load("PROTO Inner [ field MFString url [ ] ] { Group { } }\n"
       "PROTO Outer [ field MFString url [ ] ] { Inner { url IS url } }\n",
       "EXTERNPROTO Outer [ field MFString url ] \"../lib/p.wrl#Outer\"\nOuter { url \"mine\" }\n");
  const auto& outer = dynamic_cast<const ProtoInstance&>(*world->scope.roots.at(0));
  EXPECT_EQ(field<MFString>(*outer.body.roots.at(0), "url"), MFString{"mine"});
}

// The instance gives the only field of its interface. The other one keeps the prototype's default,
// which stands in the prototype's file.
TEST_F(UrlsThroughIs, DefaultsThatAnExternprotoLeavesOutAreOfThePrototypesFile) {
  load("PROTO P [ field MFString picture \"own.png\" field MFString target [ ] ] {\n"
       "  Anchor { url IS picture parameter IS target } }\n",
       "EXTERNPROTO P [ field MFString target ] \"../lib/p.wrl\"\nP { target \"target=x\" }\n");
  EXPECT_EQ(file(drawn(0), "url"), "lib/own.png");
}

// A Script gets the URLs of the node beside it. A field of its own is known by the ending Url
// alone. Other strings of a Script stay as they are.
TEST_F(UrlsThroughIs, ScriptsGetUrlsOfTheirOwnFile) {
  load("PROTO P [ field MFString shared [ ] field MFString own [ ] field MFString words [ ] ] {\n"
       "  Group { children [ Anchor { url IS shared } DEF S Script {\n"
       "    field MFString list IS shared field MFString firstUrl IS own\n"
       "    field MFString text IS words } ] } }\n",
       "EXTERNPROTO P [ field MFString shared field MFString own field MFString words ]\n"
       "  \"../lib/p.wrl\"\nP { shared \"a.png\" own \"b.png\" words \"c\" }\n");
  const auto& group = dynamic_cast<const nodes::Group&>(drawn(0));
  const Node& script = *group.children.at(1);
  EXPECT_EQ(file(*group.children.at(0), "url"), "worlds/a.png");
  EXPECT_EQ(file(script, "list"), "worlds/a.png");
  EXPECT_EQ(file(script, "firstUrl"), "worlds/b.png");
  EXPECT_EQ(field<MFString>(script, "text"), MFString{"c"});
}

TEST_F(UrlsThroughIs, PrototypesOfBuiltinNodesHaveTheFieldsOfTheNode) {
  load("EXTERNPROTO Link [ exposedField MFString url ] \"urn:web3d:vrml97:node:Anchor\"\n"
       "PROTO P [ field MFString picture [ ] ] { Link { url IS picture } }\n",
       "EXTERNPROTO P [ field MFString picture ] \"../lib/p.wrl#P\"\nP { picture \"a.png\" }\n");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/a.png");
}

// Their nodes are in the file of the EXTERNPROTO.
TEST_F(UrlsThroughIs, UrlsOfBuiltinNodesCountFromTheFileOfTheInstance) {
  load("EXTERNPROTO Link [ exposedField MFString url ] \"urn:web3d:vrml97:node:Anchor\"\n"
       "PROTO P [ ] { Link { url \"own.png\" } }\n",
       "EXTERNPROTO Link [ exposedField MFString url ] \"urn:web3d:vrml97:node:Anchor\"\n"
       "EXTERNPROTO P [ ] \"../lib/p.wrl#P\"\nLink { url \"mine.png\" } P { }\n");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "lib/own.png");
}

const std::string usesPinned = "EXTERNPROTO Pinned [ field MFString picture ] \"../lib/p.wrl\"\n"
                               "Pinned { picture \"mine.png\" }\n";

// One of the two files has no folder in its path, or only one of the paths is absolute.
TEST_F(UrlsThroughIs, RelativeAndAbsolutePathsOfFilesCanBeCompared) {
  folder.write("lib/p.wrl", header + pinned);
  folder.write("worlds/w.wrl", header + usesPinned);
  const auto former = std::filesystem::current_path();
  std::filesystem::current_path(folder.path("worlds"));
  for (const std::string name : {"w.wrl", "./w.wrl", "../worlds/w.wrl"}) {
    world = loadWorld(name);
    EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png") << name;
  }
  world = loadWorldFromMemory(header + usesPinned, "-");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  MFString urls{"mine.png"};
  rebaseUrls(urls, "w.wrl", folder.path("lib/p.wrl"));
  EXPECT_EQ(urls, MFString{"../worlds/mine.png"});
  std::filesystem::current_path(former);
}

TEST_F(UrlsThroughIs, AFileIsNamedFromAnother) {
  const std::string from = folder.write("worlds/w.wrl", header);
  for (const std::string name : {"worlds/leg.stl", "lib/a b#1%20.wrl", "x:y?/z.wrl"}) {
    const std::string url = relativeUrl(folder.write(name, header), from);
    const ResolvedUrl resolved = resolveUrl(url, from, {});
    EXPECT_EQ(resolved.error + resolved.fragment, "") << url;
    EXPECT_TRUE(std::filesystem::equivalent(resolved.path, folder.path(name))) << url;
  }
  EXPECT_EQ(relativeUrl(folder.path("worlds/leg.stl"), from), "leg.stl");
}

TEST_F(UrlsThroughIs, NamesOfFoldersAreNoPartsOfAUrl) {
  for (const std::string name : {"a#b", "p%41q", "q?v=1", "x:y", " blank "}) {
    folder.write("lib/p.wrl", header + pinned);
    folder.write(name + "/mine.png", "picture");
    world = loadWorld(folder.write(name + "/w.wrl", header + usesPinned));
    EXPECT_EQ(file(drawn(0), "url"), name + "/mine.png");
  }
}

TEST_F(UrlsThroughIs, BlanksAndQueriesMayStandInTheUrl) {
  folder.write("worlds/mine.png", "picture");
  const std::string declared = "EXTERNPROTO Pinned [ field MFString picture ] \"../lib/p.wrl\"\n";
  load(pinned,
       declared + "Pinned { picture \" mine.png \" } Pinned { picture \"mine.png?a:b\" }\n");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "worlds/mine.png");
}

// The folder lib/ is a link to deep/er/real/; ".." leads out of the real folder.
TEST_F(UrlsThroughIs, LinkedFoldersAreFollowed) {
  folder.write("deep/er/real/p.wrl", header + pinned);
  folder.write("worlds/mine.png", "picture");
  std::filesystem::create_directory_symlink(folder.path("deep/er/real"), folder.path("lib"));
  world = loadWorld(folder.write("worlds/w.wrl", header + usesPinned));
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_TRUE(std::filesystem::exists(
      resolveUrl(field<MFString>(drawn(0), "url").at(0), *drawn(0).source.file, {}).path));
}

// A field is a URL for one node and a text for another one, behind two prototypes.
TEST_F(UrlsThroughIs, StringsThatAreTextStayAsTheyAre) {
  folder.write("deep/q.wrl", header + "EXTERNPROTO P [ field MFString s ] \"../lib/p.wrl\"\n"
                                      "PROTO Q [ field MFString s \"q\" ] { P { s IS s } }\n");
  load("PROTO P [ field MFString s \"p\" ] { Group { children [ Anchor { url IS s }\n"
       "  Shape { geometry Text { string IS s } } ] } }\n",
       "EXTERNPROTO Q [ field MFString s ] \"../deep/q.wrl\"\nQ { s \"Hello\" } Q { }\n");
  for (const auto& [root, text, place] :
       {std::tuple(0, "Hello", "worlds/Hello"), std::tuple(1, "q", "deep/q")}) {
    const auto& group = dynamic_cast<const nodes::Group&>(drawn(size_t(root)));
    const auto& shape = dynamic_cast<const nodes::Shape&>(*group.children.at(1));
    EXPECT_EQ(nodeCast<nodes::Text>(shape.geometry)->string, MFString{text});
    EXPECT_EQ(file(*group.children.at(0), "url"), place);
  }
}

TEST_F(UrlsThroughIs, AWorldWrittenIntoAnotherFolderNamesTheSameFiles) {
  load(pinned, usesPinned +
                   "Pinned { } Anchor { url [ \"mine.png\" \"http://a.org/x\" \"#V\" ] }\n"
                   "PROTO Own [ field MFString u \"own.png\" ] { Anchor { url IS u } } Own { }\n");
  const std::string text = writeWorld(*world, folder.path("out/far/w.wrl"));
  EXPECT_EQ(writeWorld(*world, folder.path("worlds/other.wrl")), writeWorld(*world));
  world = loadWorld(folder.write("out/far/w.wrl", text));
  EXPECT_EQ(messages(*world), "");
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "lib/own.png");
  EXPECT_EQ(file(drawn(2), "url"), "worlds/mine.png");
  EXPECT_EQ(field<MFString>(drawn(2), "url").at(1), "http://a.org/x");
  EXPECT_EQ(field<MFString>(drawn(2), "url").at(2), "#V");
  EXPECT_EQ(file(drawn(3), "url"), "worlds/own.png");
}

TEST_F(UrlsThroughIs, AssigningAFieldToItselfChangesNothing) {
  load(pinned, usesPinned + "Pinned { }\n");
  for (const NodeRef& root : world->scope.roots)
    ASSERT_TRUE(setField(*world, *root, "picture", field<MFString>(*root, "picture")));
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "lib/own.png");
  world = loadWorldFromMemory(writeWorld(*world), folder.path("worlds/again.wrl"));
  EXPECT_EQ(file(drawn(0), "url"), "worlds/mine.png");
  EXPECT_EQ(file(drawn(1), "url"), "lib/own.png");
}

#pragma GCC diagnostic ignored "-Winvalid-offsetof" // one base, not virtual

// A node such as a plug-in describes it, with a field called `url`.
struct Described : Node {
  using Node::Node;
  MFString url;
};

constexpr FieldRow described(bool holdsUrls) {
  return {"url",
          FieldType::MFString,
          Access::field,
          Change::none,
          holdsUrls ? fieldHoldsUrls : uint8_t(0),
          offsetof(Described, url),
          {},
          "",
          "Strings."};
}

TEST(UrlFields, APluginsFieldIsOneOnlyIfItsStanzaSaysSo) {
  for (const bool holdsUrls : {false, true}) {
    const FieldRow fields[] = {described(holdsUrls)};
    const NodeRow row = {"Described", "child",   "mine", Standard::none,
                         "",          "A node.", fields, createNode<Described>};
    const NodeType type = makeNodeType(row, int(nodeTypes().size()));
    EXPECT_EQ(type.find("url")->holdsUrls, holdsUrls);
    World world;
    auto* const node = new Described(type);
    const NodeRef kept(node);
    node->source.file = std::make_shared<const std::string>("lib/p.wrl");
    auto interface = std::make_shared<NodeType>();
    interface->name = "P";
    interface->index = ProtoInstance::typeIndex;
    FieldInfo declared = *type.find("url");
    declared.offset = 0;
    interface->fields.push_back(declared);
    auto prototype = std::make_shared<ProtoDeclaration>();
    prototype->type = interface;
    auto* const instance = new ProtoInstance(interface, prototype);
    const NodeRef keptInstance(instance);
    instance->source.file = std::make_shared<const std::string>("worlds/w.wrl");
    instance->is.push_back({kept, "url", "url"});
    ASSERT_TRUE(setField(world, *instance, "url", MFString{"a.png"}));
    EXPECT_EQ(node->url, MFString{holdsUrls ? "../worlds/a.png" : "a.png"});
  }
}

} // namespace
