// xvrml_parser_proto.cpp: what prototype instances, EXTERNPROTOs and Inlines stand for once a world
// is loaded.
#include <fmt/format.h>

#include "graph/inline_node.h"
#include "unit/xvrml_parser_support.h"

namespace {

using namespace parser_test;

const nodes::Material* materialOf(const NodeRef& root) {
  const auto* shape = nodeCast<nodes::Shape>(renderedNode(root.get()));
  return shape ? nodeCast<nodes::Material>(
                     renderedNode(nodeCast<nodes::Appearance>(renderedNode(shape->appearance.get()))
                                      ->material.get()))
               : nullptr;
}

const std::string painted =
    "PROTO Painted [ exposedField SFColor tint 1 0 0 field SFNode form Box { } ] {\n"
    "  Shape { appearance Appearance { material Material { diffuseColor IS tint } } geometry IS "
    "form }\n}\n";

TEST(ParserProto, ValuesReachTheBody) {
  const auto world = parse(painted + "Painted { } Painted { tint 0 1 0 form Sphere { radius 4 } }");
  ASSERT_EQ(messages(*world), "");
  ASSERT_EQ(world->scope.roots.size(), 2u);
  EXPECT_EQ(materialOf(world->scope.roots[0])->diffuseColor, (Color{1, 0, 0}));
  EXPECT_EQ(materialOf(world->scope.roots[1])->diffuseColor, (Color{0, 1, 0}));
  const auto* first = nodeCast<nodes::Shape>(renderedNode(world->scope.roots[0].get()));
  const auto* second = nodeCast<nodes::Shape>(renderedNode(world->scope.roots[1].get()));
  EXPECT_NE(nodeCast<nodes::Box>(first->geometry), nullptr);
  EXPECT_EQ(nodeCast<nodes::Sphere>(second->geometry)->radius, 4);
}

TEST(ParserProto, NodeCastTellsWhatNodesOfAWorldAre) {
  const auto world = parse("PROTO P [ ] { Group { } }\nP { }\nScript { }\nInline { }\nGroup { }");
  ASSERT_EQ(messages(*world), "");
  const std::vector<NodeRef>& roots = world->scope.roots;
  ASSERT_EQ(roots.size(), 4u);
  const NodeRef bare(new nodes::Inline()); // made by a program: it has no place for content
  for (size_t i = 0; i < roots.size(); ++i) {
    EXPECT_EQ(nodeCast<ProtoInstance>(roots[i]) != nullptr, i == 0) << i;
    EXPECT_EQ(nodeCast<ScriptNode>(roots[i]) != nullptr, i == 1) << i;
    EXPECT_EQ(nodeCast<InlineNode>(roots[i]) != nullptr, i == 2) << i;
  }
  EXPECT_EQ(nodeCast<InlineNode>(bare), nullptr);
  const Node* constant = roots[0].get();
  EXPECT_EQ(nodeCast<ProtoInstance>(constant), constant);
}

TEST(ParserProto, PrototypesOfManyFieldsFindEachByItsName) {
  std::string fields, connections, given;
  for (int i = 0; i < 300; ++i) {
    fields += fmt::format("field SFFloat f{} {}\n", i, i);
    connections += fmt::format("field SFFloat g{} IS f{}\n", i, 299 - i);
    if (i % 3 == 0) given += fmt::format("f{} {}\n", i, -1 - i);
  }
  const auto world = parse("PROTO P [\n" + fields + "] { Group { } Script {\n" + connections +
                           "} }\nP {\n" + given + "}\nP { }");
  ASSERT_EQ(messages(*world), "");
  for (size_t k = 0; k < 2; ++k) {
    auto* instance = dynamic_cast<ProtoInstance*>(world->scope.roots[k].get());
    ASSERT_NE(instance, nullptr);
    ASSERT_EQ(instance->is.size(), 300u);
    for (const IsConnection& connection : instance->is) {
      const int i = 299 - std::stoi(connection.field.substr(1));
      const FieldInfo* field = connection.node->type().find(connection.field);
      EXPECT_EQ(std::get<SFFloat>(connection.node->get(*field)),
                k == 0 && i % 3 == 0 ? float(-1 - i) : float(i))
          << i;
    }
  }
}

TEST(ParserProto, InstancesShareOnlyWhatNothingCanChange) {
  const auto world =
      parse("PROTO P [ field SFColor c 1 0 0 ] {\n"
            "  Group { children [ Shape { appearance Appearance { material Material { diffuseColor "
            "IS c } } geometry DEF G Box { } }\n"
            "    Transform { children DEF M Shape { geometry Cone { } } } DEF T Transform { } ] }\n"
            "  Script { field SFNode g USE M }\n ROUTE T.translation TO T.scale }\nP { } P { }");
  ASSERT_EQ(messages(*world), "");
  const auto* a = nodeCast<nodes::Group>(renderedNode(world->scope.roots[0].get()));
  const auto* b = nodeCast<nodes::Group>(renderedNode(world->scope.roots[1].get()));
  ASSERT_NE(a, b);
  const auto* shapeA = nodeCast<nodes::Shape>(a->children[0]);
  const auto* shapeB = nodeCast<nodes::Shape>(b->children[0]);
  EXPECT_NE(shapeA, shapeB);                                 // holds a connected node
  EXPECT_EQ(shapeA->geometry.get(), shapeB->geometry.get()); // stored once
  EXPECT_NE(a->children[1].get(), b->children[1].get());     // holds what a Script can reach
  EXPECT_NE(a->children[2].get(), b->children[2].get());     // routed
}

TEST(ParserProto, NestedConnectionsPassValuesOn) {
  const auto world = parse(
      "PROTO Inner [ field SFFloat r 1 ] { Shape { geometry Sphere { radius IS r } } }\n"
      "PROTO Outer [ field SFFloat size 7 ] { Inner { r IS size } }\nOuter { } Outer { size 9 }");
  ASSERT_EQ(messages(*world), "");
  const auto radius = [&](int i) {
    return nodeCast<nodes::Sphere>(
               nodeCast<nodes::Shape>(renderedNode(world->scope.roots[size_t(i)].get()))->geometry)
        ->radius;
  };
  EXPECT_EQ(radius(0), 7);
  EXPECT_EQ(radius(1), 9);
}

TEST(ParserProto, BodyRoutesAndNamesAreOfTheCopy) {
  const auto world = parse("PROTO P [ ] { DEF T Transform { } DEF I PositionInterpolator { } ROUTE "
                           "I.value_changed TO T.translation }\nP { } P { }");
  const auto& a = dynamic_cast<ProtoInstance&>(*world->scope.roots[0]);
  const auto& b = dynamic_cast<ProtoInstance&>(*world->scope.roots[1]);
  ASSERT_EQ(a.body.routes.size(), 1u);
  EXPECT_EQ(a.body.routes[0].to, a.body.roots[0]);
  EXPECT_EQ(a.body.names.at("T"), a.body.roots[0]);
  EXPECT_NE(a.body.routes[0].to, b.body.routes[0].to);
  EXPECT_EQ(a.declaration, b.declaration);
}

TEST(ParserProto, AScriptMayHoldItsOwnParent) {
  const auto world =
      parse("DEF T Transform { children [ DEF S Script { field SFNode target USE T } ] }");
  ASSERT_EQ(messages(*world), "");
  const Node& script = *world->scope.names.at("S");
  EXPECT_EQ(field<NodeRef>(script, "target"), world->scope.names.at("T"));
}

TEST(ParserProto, AnInstanceMustNotDrawItsOwnParent) {
  const auto world = parse("PROTO P [ field MFNode c [ ] ] { Group { children IS c } }\nDEF T "
                           "Transform { children [ P { c USE T } ] }");
  EXPECT_TRUE(says(*world, "its own descendant")) << messages(*world);
  const auto* transform = nodeCast<nodes::Transform>(world->scope.roots[0]);
  EXPECT_TRUE(nodeCast<nodes::Group>(renderedNode(transform->children[0].get()))->children.empty());
}

TEST(ParserProto, ValueOfTheWrongKindOfNode) {
  const auto world = parse(painted + "Painted { form Material { } }");
  EXPECT_TRUE(says(*world, "'Material' cannot be in field geometry of Shape")) << messages(*world);
  EXPECT_FALSE(nodeCast<nodes::Shape>(renderedNode(world->scope.roots[0].get()))->geometry);
}

TEST(ParserProto, ExternprotoTakesUndeclaredDefaultsFromTheFile) {
  const Folder folder;
  folder.write("lib/painted.wrl", header + painted);
  const auto path =
      folder.write("world.wrl", header + "EXTERNPROTO Painted [ exposedField SFColor tint ] [ "
                                         "\"urn:x\" \"lib/painted.wrl#Painted\" ]\n"
                                         "Painted { } Painted { tint 0 0 1 }\n");
  const auto world = loadWorld(path);
  ASSERT_EQ(messages(*world), "");
  EXPECT_EQ(materialOf(world->scope.roots[0])->diffuseColor, (Color{1, 0, 0}));
  EXPECT_EQ(materialOf(world->scope.roots[1])->diffuseColor, (Color{0, 0, 1}));
  EXPECT_TRUE(nodeCast<nodes::Shape>(renderedNode(world->scope.roots[1].get()))->geometry);
}

TEST(ParserProto, ExternprotoThatIsNotThere) {
  const auto world = parse("EXTERNPROTO P [ field SFFloat x ] [ \"http://example.org/p.wrl\" "
                           "\"no/such.wrl\" ]\nP { x 1 } P { } Shape { }");
  EXPECT_EQ(world->diagnostics.errors(), 0u);
  EXPECT_EQ(world->diagnostics.warnings(), 1u) << messages(*world); // once, however many instances
  EXPECT_TRUE(says(*world, "http: URLs are not fetched"));
  EXPECT_EQ(world->scope.roots.size(), 3u);
  EXPECT_EQ(renderedNode(world->scope.roots[0].get()), nullptr);
}

TEST(ParserProto, UrlsOfInstancesAreOfTheirOwnFile) {
  const Folder folder;
  folder.write("lib/p.wrl",
               header + "PROTO P [ exposedField MFString url \"own.png\" ] { Shape { appearance "
                        "Appearance { texture ImageTexture { url IS url } } } }\n");
  const auto path =
      folder.write("worlds/w.wrl", header + "EXTERNPROTO P [ exposedField MFString url ] "
                                            "\"../lib/p.wrl\"\nP { url \"mine.png\" } P { }\n");
  const auto world = loadWorld(path);
  ASSERT_EQ(messages(*world), "");
  const auto url = [&](size_t i) {
    const auto* shape = nodeCast<nodes::Shape>(renderedNode(world->scope.roots[i].get()));
    const auto* texture =
        nodeCast<nodes::ImageTexture>(nodeCast<nodes::Appearance>(shape->appearance)->texture);
    const auto resolved = resolveUrl(texture->url.at(0), *texture->source.file, {});
    return std::filesystem::weakly_canonical(resolved.path).string();
  };
  EXPECT_EQ(url(0), std::filesystem::weakly_canonical(folder.path("worlds/mine.png")).string());
  EXPECT_EQ(url(1), std::filesystem::weakly_canonical(folder.path("lib/own.png")).string());
}

TEST(ParserInline, ContentIsSharedUnlessItChanges) {
  const Folder folder;
  folder.write("still.wrl", header + "Shape { }\n");
  folder.write("moving.wrl", header + "DEF T Transform { } ROUTE T.translation TO T.scale\n");
  const auto path = folder.write(
      "w.wrl",
      header +
          "Inline { url \"still.wrl\" } Inline { url \"still.wrl\" } Inline { url \"moving.wrl\" } "
          "Inline { url \"moving.wrl\" } Inline { } Inline { url \"none.wrl\" }\n");
  const auto world = loadWorld(path);
  const auto content = [&](size_t i) { return inlineScope(*world->scope.roots.at(i)); };
  ASSERT_NE(content(0), nullptr);
  EXPECT_EQ(content(0), content(1));
  EXPECT_NE(content(2), content(3));
  EXPECT_EQ(content(4), nullptr);
  EXPECT_EQ(content(5), nullptr);
  EXPECT_EQ(world->diagnostics.warnings(), 1u) << messages(*world);
  EXPECT_EQ(content(0)->roots[0]->type().name, "Shape");
  LoadOptions options;
  options.loadInlines = false;
  EXPECT_EQ(inlineScope(*loadWorld(path, options)->scope.roots[0]), nullptr);
}

TEST(ParserInline, WithinAPrototypeOfAnotherFile) {
  const Folder folder;
  folder.write("lib/part.wrl", header + "Shape { }\n");
  folder.write("lib/p.wrl", header + "PROTO P [ ] { Inline { url \"part.wrl\" } }\n");
  const auto world =
      loadWorld(folder.write("w.wrl", header + "EXTERNPROTO P [ ] \"lib/p.wrl\"\nP { }\n"));
  ASSERT_EQ(messages(*world), "");
  const Scope* content = inlineScope(*renderedNode(world->scope.roots[0].get()));
  ASSERT_NE(content, nullptr);
  EXPECT_EQ(content->roots.size(), 1u);
}

TEST(ParserEqual, FindsDifferences) {
  const auto differs = [](const std::string& a, const std::string& b) {
    std::string difference;
    const bool equal = equalScopes(parse(a)->scope, parse(b)->scope, &difference);
    EXPECT_EQ(equal, difference.empty());
    return !equal;
  };
  EXPECT_FALSE(differs("DEF A Group { } USE A", "DEF A Group { } USE A"));
  EXPECT_TRUE(differs("DEF A Group { } USE A", "DEF A Group { } Group { }"));
  EXPECT_TRUE(differs("DEF A Group { }", "DEF B Group { }"));
  EXPECT_TRUE(differs("Group { }", "Transform { }"));
  EXPECT_TRUE(differs("Transform { }", "Transform { scale 1 1 2 }"));
  EXPECT_TRUE(differs("Group { }", "Group { } Group { }"));
  EXPECT_TRUE(differs("PROTO P [ ] { Group { } }", "PROTO P [ ] { Shape { } }"));
  EXPECT_TRUE(differs("PROTO P [ field SFFloat x 1 ] { Group { } }",
                      "PROTO P [ field SFFloat x 2 ] { Group { } }"));
  EXPECT_TRUE(differs("PROTO P [ field SFVec3f x 1 1 1 ] { Transform { scale IS x } }",
                      "PROTO P [ field SFVec3f x 1 1 1 ] { Transform { translation IS x } }"));
  EXPECT_TRUE(differs("DEF A Transform { } ROUTE A.scale TO A.translation",
                      "DEF A Transform { } ROUTE A.translation TO A.scale"));
  EXPECT_TRUE(differs("Script { field SFFloat x 1 }", "Script { field SFFloat x 2 }"));
  EXPECT_TRUE(differs("Script { eventIn SFFloat x }", "Script { eventOut SFFloat x }"));
}

// Graphs that programs made: shared nodes without a name get one.
TEST(ParserWriter, NamesWhatIsShared) {
  World world;
  const NodeRef shape(new nodes::Shape());
  world.scope.roots = {shape, shape};
  const std::string text = writeWorld(world);
  EXPECT_NE(text.find("USE _Shape1"), std::string::npos) << text;
  const auto again = loadWorldFromMemory(text, "again.wrl");
  EXPECT_EQ(messages(*again), "");
  EXPECT_EQ(again->scope.roots.at(0), again->scope.roots.at(1));
}

} // namespace
