// x3d_sensors.cpp: sensors that X3D adds, and what it adds to those of VRML97 (ISO/IEC 19775-1
// clauses 9.4.3, 20.4, 21, 22.4.1): expectations follow from the clauses.
#include <numbers>

#include "conformance/events/media_files.h"
#include "conformance/events/viewing.h"
#include "xvrml/nodes.h"
#include "xvrml/renderer.h"

namespace xvrml {
namespace {

const std::string head = "#X3D V3.3 utf8\nPROFILE Immersive\n";

// --- KeySensor (21.4.1) ---

TEST(KeySensor, SendsCharactersAndTheNumbersOfActionKeys) {
  Running r(head + "DEF K KeySensor { }\n");
  for (const char* out : {"keyPress", "keyRelease", "actionKeyPress", "actionKeyRelease",
                          "shiftKey", "controlKey", "altKey"})
    r.log("K", out);
  EXPECT_TRUE(r.browser.sensesKeys());
  EXPECT_TRUE(r.browser.worldKey("a", true));
  EXPECT_TRUE(r.browser.worldKey("a", false));
  EXPECT_TRUE(r.browser.worldKey("Shift", true));
  EXPECT_TRUE(r.browser.worldKey("\xc3\x9c", true));
  EXPECT_TRUE(r.browser.worldKey("Shift", false));
  EXPECT_EQ(r.take(), (Log{"0 K.keyPress a", "0 K.keyRelease a", "0 K.shiftKey TRUE",
                           "0 K.keyPress \xc3\x9c", "0 K.shiftKey FALSE"}));
  const char* const names[] = {"F1",       "F12", "Home", "End",  "PageUp",
                               "PageDown", "Up",  "Down", "Left", "Right"};
  std::string numbers;
  for (const char* name : names) {
    r.browser.worldKey(name, true);
    numbers += r.get("K", "actionKeyPress") + " ";
  }
  EXPECT_EQ(numbers, "1 12 13 14 15 16 17 18 19 20 "); // table 21.2
  r.take();
  for (const char* nothing : {"", "ab", "F13", "\xc3", "\xff", "Enter "})
    EXPECT_FALSE(r.browser.worldKey(nothing, true)) << nothing;
  EXPECT_FALSE(r.browser.worldKey(std::string_view("\0", 1), true));
  EXPECT_EQ(r.take(), Log());
}

TEST(KeySensor, IsActiveWhileItIsEnabled) {
  Running r(head + "DEF K KeySensor { enabled FALSE }\n");
  r.log("K", "isActive");
  r.log("K", "keyPress");
  EXPECT_FALSE(r.browser.worldKey("a", true));
  r.set("K", "enabled", true);
  r.browser.worldKey("b", true);
  r.set("K", "enabled", false);
  EXPECT_FALSE(r.browser.sensesKeys());
  EXPECT_FALSE(r.browser.worldText("c"));
  EXPECT_EQ(r.take(), (Log{"0 K.isActive TRUE", "0 K.keyPress b", "0 K.isActive FALSE"}));
}

// 21.2: the sensor that becomes enabled sends enabled FALSE to the one that was.
TEST(KeySensor, OneSensorIsActiveAtATime) {
  Running r(head + "DEF A KeySensor { }\nDEF B StringSensor { enabled FALSE }\n");
  for (const char* name : {"A", "B"}) {
    r.log(name, "isActive");
    r.log(name, "enabled");
  }
  EXPECT_EQ(r.get("A", "isActive"), "TRUE");
  r.set("B", "enabled", true);
  EXPECT_EQ(r.take(), (Log{"0 B.enabled TRUE", "0 B.isActive TRUE", "0 A.enabled FALSE",
                           "0 A.isActive FALSE"}));
  r.set("A", "enabled", true);
  EXPECT_EQ(r.get("B", "enabled"), "FALSE");
  EXPECT_EQ(r.get("A", "isActive"), "TRUE");
  // of those that a file enables it is the last one
  Running two(head + "DEF A KeySensor { }\nDEF B KeySensor { }\n");
  EXPECT_EQ(two.get("A", "enabled"), "FALSE");
  EXPECT_EQ(two.get("B", "isActive"), "TRUE");
}

TEST(KeySensor, OutsideOfTheSceneSensesNothing) {
  Running r(head + "DEF G Group { children DEF K KeySensor { } }\n");
  EXPECT_TRUE(r.browser.worldKey("a", true));
  r.set("G", "children", MFNode{});
  EXPECT_FALSE(r.browser.sensesKeys());
  EXPECT_FALSE(r.browser.worldKey("a", true));
}

// --- StringSensor (21.4.2) ---

TEST(StringSensor, CollectsTextUntilEnter) {
  Running r(head + "DEF S StringSensor { }\n");
  for (const char* out : {"enteredText", "finalText"}) r.log("S", out);
  EXPECT_TRUE(r.browser.worldText("h\xc3\xbc"));
  r.browser.worldKey("Shift", true);
  r.browser.worldKey("Left", true);
  r.browser.worldKey("Backspace", true);
  r.browser.worldText("i\n");
  r.browser.worldText("x");
  EXPECT_EQ(r.take(), (Log{"0 S.enteredText h", "0 S.enteredText h\xc3\xbc", "0 S.enteredText h",
                           "0 S.enteredText hi", "0 S.finalText hi", "0 S.enteredText ",
                           "0 S.enteredText x"}));
}

TEST(StringSensor, DeletesOnlyIfAllowedAndWhatIsThere) {
  Running r(head + "DEF S StringSensor { }\n");
  r.log("S", "enteredText");
  r.browser.worldKey("Backspace", true);
  EXPECT_EQ(r.take(), Log());
  r.set("S", "deletionAllowed", false);
  r.browser.worldText("ab");
  r.browser.worldKey("Backspace", true);
  EXPECT_EQ(r.get("S", "enteredText"), "ab");
  r.set("S", "enabled", false); // the text is given up
  r.set("S", "enabled", true);
  r.browser.worldText("c");
  EXPECT_EQ(r.get("S", "enteredText"), "c");
}

// --- LoadSensor (9.4.3) ---

Browser* loading(std::unique_ptr<Browser>& made, const Folder& folder, const std::string& text,
                 Log& events, bool loadInlines = true) {
  folder.write("part.x3dv", head + "Group { }\n");
  folder.write("clip.wav", wav(std::vector<int16_t>(100, 0), 1, 100));
  folder.write("picture.png", "any bytes");
  LoadOptions options;
  options.loadInlines = loadInlines;
  made = std::make_unique<Browser>(loadWorldFromMemory(head + text, folder / "world.x3dv", options),
                                   BrowserOptions(), 0, RunOptions{.epoch = 0});
  for (const char* out : {"isActive", "isLoaded", "loadTime", "progress"})
    made->listen(*made->node("L"), out,
                 [&events, &made, out](Node&, const FieldInfo&, const Value& v) {
                   events.push_back(fmt::format("{:g} {} {}", made->now(), out, textOf(v)));
                 });
  return made.get();
}

TEST(LoadSensor, TellsThatAllIsLoaded) {
  const Folder folder;
  Log events;
  std::unique_ptr<Browser> made;
  loading(made, folder,
          "DEF L LoadSensor { watchList [ Inline { url \"part.x3dv\" } ImageTexture { url [ "
          "\"no.png\" \"picture.png\" ] } AudioClip { url \"clip.wav\" } ] }\n",
          events);
  for (const double time : {1, 2, 3}) made->tick(time);
  EXPECT_EQ(events, (Log{"1 isActive TRUE", "1 progress 0", "2 progress 1", "2 isLoaded TRUE",
                         "2 loadTime 2", "2 isActive FALSE"}));
  events.clear();
  made->set(*made->node("L"), "watchList", MFNode{}); // nothing is watched
  made->tick(4);
  EXPECT_EQ(events, Log());
}

TEST(LoadSensor, TellsWhatFails) {
  const Folder folder;
  for (const char* watched : {"Inline { url \"no.x3dv\" }", "ImageTexture { url \"no.png\" }",
                              "AudioClip { url \"no.wav\" }", "Background { topUrl \"no.png\" }"}) {
    Log events;
    std::unique_ptr<Browser> made;
    loading(made, folder,
            "DEF L LoadSensor { watchList [ Inline { url \"part.x3dv\" } " + std::string(watched) +
                " ] }\n",
            events);
    for (const double time : {1, 2, 3}) made->tick(time);
    EXPECT_EQ(events, (Log{"1 isActive TRUE", "1 progress 0", "2 progress 0.5", "2 isLoaded FALSE",
                           "2 isActive FALSE"}))
        << watched;
  }
}

TEST(LoadSensor, WaitsForInlinesUntilTheTimeIsOver) {
  const Folder folder;
  Log events;
  std::unique_ptr<Browser> made;
  const std::string text = "DEF L LoadSensor { timeOut 5 watchList DEF I Inline { load FALSE url "
                           "\"part.x3dv\" } }\n";
  loading(made, folder, text, events);
  for (const double time : {1, 3, 7}) made->tick(time);
  EXPECT_EQ(events,
            (Log{"1 isActive TRUE", "1 progress 0", "7 isLoaded FALSE", "7 isActive FALSE"}));
  events.clear();
  loading(made, folder, text, events);
  made->tick(1);
  made->set(*made->node("I"), "load", true);
  made->tick(3);
  EXPECT_EQ(events, (Log{"1 isActive TRUE", "1 progress 0", "3 progress 1", "3 isLoaded TRUE",
                         "3 loadTime 3", "3 isActive FALSE"}));
}

// A new url or load resets the sensor, and its time (9.4.3).
TEST(LoadSensor, BeginsAgainWithNewFiles) {
  const Folder folder;
  Log events;
  std::unique_ptr<Browser> made;
  Browser& browser = *loading(made, folder,
                              "DEF L LoadSensor { watchList [ DEF I Inline { url \"part.x3dv\" } "
                              "DEF P ImageTexture { url \"picture.png\" } ] }\n",
                              events);
  const auto after = [&](double time, const char* name, const char* field, Value value) {
    events.clear();
    browser.set(*browser.node(name), field, std::move(value));
    browser.tick(time);
    browser.tick(time + 1);
    browser.tick(time + 2);
    return events;
  };
  browser.tick(1);
  browser.tick(2);
  EXPECT_EQ(after(3, "P", "url", MFString{"no.png"}),
            (Log{"3 isActive TRUE", "3 progress 0", "4 progress 0.5", "4 isLoaded FALSE",
                 "4 isActive FALSE"}));
  EXPECT_EQ(after(6, "P", "url", MFString{"picture.png"}),
            (Log{"6 isActive TRUE", "6 progress 0", "7 progress 1", "7 isLoaded TRUE",
                 "7 loadTime 7", "7 isActive FALSE"}));
  EXPECT_EQ(after(9, "I", "url", MFString{"no.x3dv"}),
            (Log{"9 isActive TRUE", "9 progress 0", "10 progress 0.5", "10 isLoaded FALSE",
                 "10 isActive FALSE"}));
  EXPECT_EQ(after(12, "I", "load", false), // it waits for its content
            (Log{"12 isActive TRUE", "12 progress 0", "13 progress 0.5"}));
  browser.set(*browser.node("L"), "timeOut", 10.0);
  browser.set(*browser.node("P"), "url", MFString{"picture.png"}); // at 14: until 24
  events.clear();
  browser.tick(23);
  EXPECT_EQ(events, Log{"23 progress 0.5"});
  browser.tick(24);
  EXPECT_EQ(events, (Log{"23 progress 0.5", "24 isLoaded FALSE", "24 isActive FALSE"}));
  EXPECT_EQ(after(30, "L", "watchList", MFNode{}), Log());
  EXPECT_EQ(after(40, "P", "url", MFString{"no.png"}), Log()); // it is not watched any more
}

// Watched nodes stand where else they are used: the pointer meets nothing at the sensor, and a walk
// over what is drawn finds it once.
TEST(LoadSensor, PlacesNothing) {
  const Folder folder;
  folder.write("part.x3dv", head + "DEF V Viewpoint { }\nShape { geometry Box { } }\n");
  Browser browser(
      loadWorldFromMemory(head + "LoadSensor { watchList DEF I Inline { url \"part.x3dv\" } }\n"
                                 "Transform { translation 9 0 0 children USE I }\n",
                          folder / "world.x3dv", LoadOptions()));
  browser.tick(0);
  const double along[] = {0, 0, -1}, atSensor[] = {0, 0, 5}, atInline[] = {9, 0, 5};
  PickHit hit;
  EXPECT_FALSE(browser.pick(atSensor, along, {}, hit));
  EXPECT_TRUE(browser.pick(atInline, along, {}, hit));
  struct Counter : Renderer {
    int shapes = 0;
    void draw(const DrawnShape&) override { ++shapes; }
  } counter;
  render(browser.world(), counter);
  EXPECT_EQ(counter.shapes, 1);
}

TEST(LoadSensor, IsWrittenWithTheNameOfItsVersion) {
  const auto three = loadWorldFromMemory(head + "LoadSensor { watchList Inline { } }\n", "a.x3dv");
  EXPECT_NE(writeWorld(*three, "a.x3dv").find("watchList"), std::string::npos);
  const auto four = loadWorldFromMemory(
      "#X3D V4.0 utf8\nPROFILE Immersive\nLoadSensor { children Inline { } }\n", "a.x3dv");
  EXPECT_EQ(four->diagnostics.list().size(), 0U);
  EXPECT_EQ(writeWorld(*four, "a.x3dv").find("watchList"), std::string::npos);
  EXPECT_EQ(nodeCast<nodes::LoadSensor>(four->scope.roots[0])->watchList.size(), 1U);
}

// --- Inline.load (9.4.2) ---

TEST(InlineLoad, LoadsAndUnloads) {
  const Folder folder;
  folder.write("part.x3dv", head + "DEF T Transform { translation 1 2 3 children Shape { geometry "
                                   "Box { } } }\n");
  Browser browser(loadWorldFromMemory(head + "DEF I Inline { load FALSE url \"part.x3dv\" }\n",
                                      folder / "world.x3dv"));
  Node& node = *browser.node("I");
  EXPECT_EQ(inlineScope(node), nullptr);
  const double origin[3] = {1, 2, 10}, direction[3] = {0, 0, -1};
  PickHit hit;
  EXPECT_FALSE(browser.pick(origin, direction, {}, hit));
  browser.takeChanges();
  browser.set(node, "load", true);
  ASSERT_NE(inlineScope(node), nullptr);
  EXPECT_TRUE(browser.hasChanges());
  EXPECT_TRUE(browser.pick(origin, direction, {}, hit));
  const Scope* content = inlineScope(node);
  browser.set(node, "load", true); // it is loaded: nothing is read again
  EXPECT_EQ(inlineScope(node), content);
  browser.set(node, "load", false);
  EXPECT_EQ(inlineScope(node), nullptr);
  EXPECT_FALSE(browser.pick(origin, direction, {}, hit));
  browser.set(node, "url", MFString{"part.x3dv"}); // not before load is TRUE
  EXPECT_EQ(inlineScope(node), nullptr);
  browser.loadInlines();
  EXPECT_EQ(inlineScope(node), nullptr);
  browser.set(node, "load", true);
  EXPECT_NE(inlineScope(node), nullptr);
  EXPECT_EQ(browser.world().diagnostics.list().size(), 0U);
}

// --- LOD (23.4.3) ---

TEST(LodLevel, IsSentWhenTheViewersDistanceChoosesAnother) {
  Running r(head +
            "DEF V Viewpoint { position 0 0 10 }\nTransform { scale 2 2 2 children DEF L LOD "
            "{ range [ 3 8 ] children [ Shape { } Shape { } Shape { } ] } }\n"
            "DEF W Switch { }\nROUTE L.level_changed TO W.whichChoice\n");
  r.log("L", "activeLevel_changed");
  r.browser.tick(1);
  EXPECT_EQ(r.get("W", "whichChoice"), "1"); // the distance is 5 in the LOD's coordinates
  r.set("V", "position", Vec3f{0, 0, 20});
  r.browser.tick(2);
  r.browser.tick(3);
  r.set("V", "position", Vec3f{0, 0, 4});
  r.browser.tick(4);
  EXPECT_EQ(r.take(), (Log{"1 L.activeLevel_changed 1", "2 L.activeLevel_changed 2",
                           "4 L.activeLevel_changed 0"}));
}

// --- ProximitySensor (22.4.1) ---

TEST(ProximitySensor, TellsTheCenterOfRotation) {
  Running r(head + "DEF V Viewpoint { position 0 0 0 centerOfRotation 1 2 3 }\nTransform { "
                   "translation 1 0 0 children DEF P ProximitySensor { size 100 100 100 } }\n");
  r.log("P", "centerOfRotation_changed");
  r.browser.tick(1);
  r.browser.tick(2);
  r.set("V", "centerOfRotation", Vec3f{4, 5, 6});
  r.browser.tick(3);
  EXPECT_EQ(r.take(),
            (Log{"1 P.centerOfRotation_changed 0 2 3", "3 P.centerOfRotation_changed 3 5 6"}));
}

// --- Drag sensors (20.4) ---

void drag(Running& r, double x, double y, double z, double dx, double dy, double dz,
          bool button = true) {
  const double origin[3] = {x, y, z}, direction[3] = {dx, dy, dz};
  r.browser.pointerRay(origin, direction, button);
}

TEST(AxisRotation, TurnsThePlaneOfAPlaneSensor) {
  // The plane z = 0 is turned about x into the plane y = 0; it is seen from above.
  Running r(head +
            "Group { children [ DEF S PlaneSensor { axisRotation 1 0 0 -1.57079633 maxPosition "
            "1 9 minPosition -9 -9 } Shape { geometry Box { size 20 2 20 } } ] }\n");
  drag(r, 0, 10, 0, 0, -1, 0);
  drag(r, 0.5, 10, 2, 0, -1, 0);
  const auto moved = std::get<Vec3f>(r.browser.get(r.node("S"), "translation_changed"));
  EXPECT_NEAR(moved.x, 0.5, 1e-5);
  EXPECT_NEAR(moved.y, 0, 1e-5);
  EXPECT_NEAR(moved.z, 2, 1e-5);
  const auto track = std::get<Vec3f>(r.browser.get(r.node("S"), "trackPoint_changed"));
  EXPECT_NEAR(track.y, 1, 1e-5);
  drag(r, 5, 10, 2, 0, -1, 0); // x is limited in the turned system
  EXPECT_NEAR(std::get<Vec3f>(r.browser.get(r.node("S"), "translation_changed")).x, 1, 1e-5);
  drag(r, 5, 10, 2, 0, -1, 0, false);
  drag(r, 0, 10, 0, 0, -1, 0); // autoOffset goes on there
  drag(r, -0.5, 10, 0, 0, -1, 0);
  const auto on = std::get<Vec3f>(r.browser.get(r.node("S"), "translation_changed"));
  EXPECT_NEAR(on.x, 0.5, 1e-5);
  EXPECT_NEAR(on.z, 2, 1e-5);
}

TEST(AxisRotation, TurnsTheAxisOfACylinderSensor) {
  // The axis is z: looking along it, the sensor works as a disk.
  Running r(head +
            "Group { children [ DEF S CylinderSensor { axisRotation 1 0 0 1.57079633 } Shape { "
            "geometry Box { size 20 20 2 } } ] }\n");
  drag(r, 1, 0, 10, 0, 0, -1);
  drag(r, 0, 1, 10, 0, 0, -1);
  const auto turned = std::get<Rotation>(r.browser.get(r.node("S"), "rotation_changed"));
  EXPECT_NEAR(turned.x, 0, 1e-5);
  EXPECT_NEAR(turned.y, 0, 1e-5);
  EXPECT_NEAR(turned.z, 1, 1e-5);
  EXPECT_NEAR(turned.angle, std::numbers::pi / 2, 1e-5);
}

// --- Viewpoints (23.3.1 of :2023) ---

TEST(ViewAll, MovesBackUntilTheWorldIsSeen) {
  Running r(head + "DEF V Viewpoint { orientation 0 1 0 1.57079633 viewAll TRUE }\nTransform { "
                   "translation 5 6 7 children Shape { geometry Box { size 2 2 2 } } }\n");
  const double distance = std::sqrt(3.0) / std::sin(0.785398 / 2);
  EXPECT_EQ(eyeOf(r.browser), fmt::format("{:g} 6 7", tidy(5 + distance)));
  EXPECT_EQ(lookOf(r.browser), "-1 0 0");
  // Other viewpoints and a change of the field
  Running s(head + "DEF A Viewpoint { position 0 0 3 }\nDEF B Viewpoint { viewAll TRUE }\nShape { "
                   "geometry Sphere { radius 2 } }\n");
  EXPECT_EQ(eyeOf(s.browser), "0 0 3");
  s.set("B", "set_bind", true);
  const std::string back = eyeOf(s.browser);
  EXPECT_EQ(back, fmt::format("0 0 {:g}", tidy(std::sqrt(12.0) / std::sin(0.785398 / 2))));
  s.set("A", "set_bind", true);
  EXPECT_EQ(eyeOf(s.browser), "0 0 3");
  s.set("A", "viewAll", true);
  EXPECT_EQ(eyeOf(s.browser), back);
}

TEST(ViewAll, OfAParallelViewShowsTheWorld) {
  Running r(head +
            "OrthoViewpoint { viewAll TRUE fieldOfView [ 0 0 1 1 ] }\nTransform { translation 5 "
            "0 0 children Shape { geometry Box { size 6 6 6 } } }\n");
  const CameraSettings camera = r.browser.camera(1);
  EXPECT_NEAR(camera.height, std::sqrt(108.0), 1e-5);
  EXPECT_NEAR(camera.matrix[12], 5, 1e-5);
  EXPECT_NEAR(r.browser.camera(0.5).height, 2 * std::sqrt(108.0), 1e-5);
}

TEST(ViewAll, OfPointsAndLinesLooksAtThem) {
  Running r(head + "Viewpoint { viewAll TRUE }\nTransform { translation 30 1 0 children Shape { "
                   "geometry PointSet { coord Coordinate { point [ 0 0 -5 ] } } } }\n");
  EXPECT_EQ(eyeOf(r.browser), "30 1 -4"); // any distance will do
  Running s(head + "Viewpoint { viewAll TRUE }\nShape { geometry LineSet { vertexCount 2 coord "
                   "Coordinate { point [ 8 0 0, 12 0 0 ] } } }\n");
  EXPECT_EQ(eyeOf(s.browser), fmt::format("10 0 {:g}", tidy(2 / std::sin(0.785398 / 2))));
  Running t(head +
            "OrthoViewpoint { viewAll TRUE }\nShape { geometry PointSet { coord Coordinate { "
            "point [ 7 7 7 ] } } }\n");
  EXPECT_EQ(eyeOf(t.browser), "7 7 8");
  EXPECT_GT(t.browser.camera(1).height, 0.1);
}

TEST(ViewAll, OfNothingStaysWhereItIs) {
  for (const char* world : {"", "Shape { geometry Box { size 1e38 1e38 1e38 } }",
                            "Transform { scale 0 0 0 children Shape { geometry Box { } } }"}) {
    Running r(head + "Viewpoint { position 1 2 3 viewAll TRUE }\n" + world + "\n");
    for (const double number : r.browser.camera(1).matrix) EXPECT_TRUE(std::isfinite(number));
    EXPECT_TRUE(*world || eyeOf(r.browser) == "1 2 3") << eyeOf(r.browser);
  }
}

TEST(NavigationInfoOfAViewpoint, IsBoundWithIt) {
  Running r(head +
            "DEF N NavigationInfo { }\nDEF A Viewpoint { }\nDEF B Viewpoint { navigationInfo DEF "
            "M NavigationInfo { type \"FLY\" } }\n");
  EXPECT_EQ(nameOf(r.browser.bound().navigationInfo), "N");
  r.log("M", "isBound");
  r.set("B", "set_bind", true);
  EXPECT_EQ(nameOf(r.browser.bound().navigationInfo), "M");
  r.set("A", "set_bind", true);
  EXPECT_EQ(nameOf(r.browser.bound().navigationInfo), "N");
  EXPECT_EQ(r.take(), (Log{"0 M.isBound TRUE", "0 M.isBound FALSE"}));
  Running first(head + "DEF A Viewpoint { navigationInfo DEF M NavigationInfo { } }\n");
  EXPECT_EQ(nameOf(first.browser.bound().navigationInfo), "M");
}

// --- CAD (clause 32) ---

TEST(Cad, PartsPlaceTheirFaces) {
  Running r(head + "CADAssembly { children DEF P CADPart { translation 3 0 0 children [ DEF T "
                   "TouchSensor { } CADFace { shape Shape { geometry Box { } } } ] } }\n");
  r.log("T", "isOver");
  const double direction[3] = {0, 0, -1};
  const double there[3] = {3, 0, 10}, here[3] = {0, 0, 10};
  r.browser.pointerRay(here, direction, false);
  EXPECT_EQ(r.take(), Log());
  r.browser.pointerRay(there, direction, false);
  EXPECT_EQ(r.take(), (Log{"0 T.isOver TRUE"}));
  r.set("P", "translation", Vec3f{0, 0, 0});
  const double beside[3] = {3, 0.5, 10}; // a pointer at rest sends nothing
  r.browser.pointerRay(beside, direction, false);
  EXPECT_EQ(r.take(), (Log{"0 T.isOver FALSE"}));
  r.browser.pointerRay(here, direction, false);
  EXPECT_EQ(r.take(), (Log{"0 T.isOver TRUE"}));
}

TEST(Cad, ProximityUsesTheMatrixOfAPart) {
  Running r(head +
            "CADPart { translation 0 0 10 children DEF S ProximitySensor { size 1 1 1 } }\n");
  r.browser.tick(1);
  EXPECT_EQ(r.get("S", "position_changed"), "0 0 0");
}

TEST(Cad, LayersShowTheirChildrenOneByOne) {
  Running r(head +
            "DEF L CADLayer { visible [ FALSE ] children [ Shape { geometry Box { } } Transform "
            "{ translation 4 0 0 children Shape { geometry Box { } } } ] }\n");
  const double direction[3] = {0, 0, -1};
  const double left[3] = {0, 0, 10}, right[3] = {4, 0, 10};
  PickHit hit;
  EXPECT_FALSE(r.browser.pick(left, direction, {}, hit));
  EXPECT_TRUE(r.browser.pick(right, direction, {}, hit)); // beyond the list: TRUE
  r.set("L", "visible", MFBool{true, false, true, true});
  EXPECT_TRUE(r.browser.pick(left, direction, {}, hit));
  EXPECT_FALSE(r.browser.pick(right, direction, {}, hit));
}

// 7.3.3: an event to the field metadata has no effect on the node, whatever its behaviour is.
TEST(Metadata, EventsOfItReachNoBehaviour) {
  Running r(head +
            "DEF M MetadataSet { }\nDEF F BooleanFilter { }\nDEF I IntegerTrigger { }\n"
            "DEF D PositionDamper { }\nDEF Q BooleanSequencer { key [ 0 ] keyValue [ TRUE ] }");
  for (const char* out : {"inputTrue", "inputFalse"}) r.log("F", out);
  r.log("I", "triggerValue");
  r.log("D", "value_changed");
  r.log("Q", "value_changed");
  for (const char* name : {"F", "I", "D", "Q"}) r.set(name, "metadata", NodeRef(&r.node("M")));
  EXPECT_EQ(r.take(), Log{});
}

} // namespace
} // namespace xvrml
