// xvrml_edit_lists.cpp: Tests, by random edits of lists at several places, that all comments of the
// list stay, and all text between elements that stay beside each other.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

// How an encoding says a list of points.
struct Syntax {
  const char* suffix;
  std::string head, before, behind; // the first line, and the text around the elements
  std::string comma;
  bool hasComments;
};

const std::vector<Syntax> syntaxes = {
    {"wrl", "#VRML V2.0 utf8\n",
     "Shape { geometry PointSet { coord DEF C Coordinate { # points\n  point [", " ] } } }\n", ",",
     true},
    {"x3dv", "#X3D V3.3 utf8\n",
     "PROFILE Immersive\nShape { geometry PointSet { coord DEF C Coordinate {\n  point [",
     "\n  ] } } }\n", "", true},
    {"x3d", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
     "<X3D profile='Immersive' version='3.3'><Scene>\n<Shape><PointSet>\n  <Coordinate DEF='C' "
     "point='",
     "'/>\n</PointSet></Shape>\n</Scene></X3D>\n", ",", false},
    {"x3dj", "{\n",
     "\"X3D\": {\"@version\": \"3.3\", \"Scene\": {\"-children\": [{\"Shape\": {\"-geometry\": "
     "{\"PointSet\": {\"-coord\": {\"Coordinate\": {\"@DEF\": \"C\",\n  \"@point\": [",
     "]}}}}}}]}}}\n", ",", false}};

// A list as the file has it: where its elements stand, and the comments in it.
struct List {
  std::string text;
  MFVec3f points;
  std::vector<size_t> begins, ends; // where the elements stand in the text
  std::vector<std::string> comments;
};

class EditedList : public Edited {
 protected:
  size_t below(size_t n) { return size_t(random()) % n; }
  std::string comment() {
    list.comments.push_back("# c" + std::to_string(list.comments.size()) + ", 1 2 3");
    return list.comments.back();
  }
  // Returns what stands behind an element, or before the first one.
  std::string separator(const Syntax& syntax, bool isBetween) {
    const std::string comma = isBetween ? syntax.comma : "";
    switch (below(syntax.hasComments ? 5 : 3)) {
    case 0: return comma + " ";
    case 1: return comma + "\n    ";
    case 2: return comma + "  \n\t";
    case 3: return comma + " " + comment() + "\n    ";
    default: {
      const std::string above = comment();
      return comma + "\n    " + above + "\n    " + comment() + "\n    ";
    }
    }
  }
  // Makes a list of points that differ, or of few kinds of points.
  void makeList(const Syntax& syntax, bool differ) {
    list = {};
    const size_t size = below(20) + 1;
    for (size_t i = 0; i < size; ++i) {
      list.text += separator(syntax, i > 0);
      list.begins.push_back(list.text.size());
      const size_t number = differ ? i : below(3);
      const std::string space =
          syntax.comma == "," && syntax.suffix == std::string("x3dj") ? ", " : " ";
      list.text += std::to_string(number) + ".50" + space + "0.250" + space + "7";
      list.ends.push_back(list.text.size());
      list.points.push_back({float(number) + .5f, .25f, 7});
    }
    list.text += separator(syntax, false);
    editor.reset();
    load(syntax.before + list.text + syntax.behind, syntax.head, std::string("w.") + syntax.suffix);
  }
  MFVec3f points() { return field<MFVec3f>(node("C"), "point"); }
  void expectSaved(const Syntax& syntax, const MFVec3f& wanted) {
    const std::string now = editor->text();
    EXPECT_EQ(points(), wanted);
    const auto reloaded = loadWorld(folder.write(std::string("again.") + syntax.suffix, now));
    EXPECT_EQ(messages(*reloaded), "");
    EXPECT_EQ((field<MFVec3f>(*reloaded->scope.names.at("C"), "point")), wanted) << now;
    size_t at = 0;
    for (const std::string& one : list.comments) {
      const size_t found = now.find(one + "\n", at);
      ASSERT_NE(found, now.npos) << one << " has gone or moved:\n" << original << now;
      at = found + one.size();
    }
  }

  std::mt19937 random;
  List list;
};
INSTANTIATE_TEST_SUITE_P(World, EditedList, testing::Values(false),
                         [](const auto&) { return "Resting"; });

// An element of an edited list: one of the file's, or a new one.
struct Element {
  Vec3f point;
  size_t old;
};
constexpr size_t isNew = ~size_t(0);

TEST_P(EditedList, WhatStandsBetweenElementsThatStayStays) {
  for (unsigned seed = 0; seed < 240; ++seed) {
    SCOPED_TRACE(seed);
    random.seed(seed);
    const Syntax& syntax = syntaxes[seed % syntaxes.size()];
    makeList(syntax, true);
    std::vector<Element> elements;
    for (size_t i = 0; i < list.points.size(); ++i) elements.push_back({list.points[i], i});
    // Edits at places that are not beside each other, from the end on.
    float next = 1000;
    for (size_t i = elements.size(); i-- > 0;) {
      const size_t edit = below(6);
      const auto place = elements.begin() + std::ptrdiff_t(i);
      if (edit == 0)
        elements.erase(place);
      else if (edit == 1)
        elements.insert(place, {{++next, 0, 0}, isNew});
      else if (edit == 2)
        *place = {{elements[i].point.x, ++next, 7}, isNew};
      if (edit < 3 && i > 0) --i;
    }
    MFVec3f wanted;
    for (const Element& one : elements) wanted.push_back(one.point);
    editor->set(node("C"), "point", wanted);
    expectSaved(syntax, wanted);
    const std::string now = editor->text();
    for (size_t i = 0; i + 1 < elements.size(); ++i) {
      const size_t old = elements[i].old;
      if (old == isNew || elements[i + 1].old != old + 1) continue;
      const std::string both =
          list.text.substr(list.begins[old], list.ends[old + 1] - list.begins[old]);
      EXPECT_NE(now.find(both), now.npos) << both << "\nis not in\n" << now << original;
    }
    undoAll();
  }
}

TEST_P(EditedList, AnyEditsLeaveTheComments) {
  for (unsigned seed = 0; seed < 240; ++seed) {
    SCOPED_TRACE(seed);
    random.seed(1000 + seed);
    const Syntax& syntax = syntaxes[seed % syntaxes.size()];
    makeList(syntax, false);
    MFVec3f wanted = list.points;
    for (size_t steps = below(4) + 1; steps > 0; --steps) {
      for (size_t edits = below(6) + 1; edits > 0; --edits) {
        const auto place = wanted.begin() + std::ptrdiff_t(below(wanted.size() + 1));
        const Vec3f point{float(below(4)) + .5f, .25f, float(below(2)) + 7};
        if (place == wanted.end() || below(3) == 0)
          wanted.insert(place, below(4) + 1, point);
        else if (below(2) == 0)
          wanted.erase(place, place + std::ptrdiff_t(below(size_t(wanted.end() - place)) + 1));
        else
          *place = point;
      }
      editor->set(node("C"), "point", wanted);
    }
    expectSaved(syntax, wanted);
    undoAll();
  }
}

TEST_P(EditedList, PixelsOfATextureChangeInTheirPlaces) {
  constexpr size_t pixels = 64 * 32;
  for (const bool isXml : {false, true}) {
    std::vector<std::string> words(pixels, "0x10F020");
    for (size_t i = 0; i < pixels; i += 3) words[i] = "66051";
    const auto textOf = [&] {
      std::string image = "64 32 3";
      for (size_t i = 0; i < pixels; ++i) image += (i % 16 ? " " : "\n    ") + words[i];
      return isXml ? "<X3D profile='Immersive' version='3.3'><Scene><Shape><Appearance>"
                     "<PixelTexture DEF='C' image='" +
                         image + "'/></Appearance></Shape></Scene></X3D>\n"
                   : "Shape { appearance Appearance { texture DEF C PixelTexture { image " + image +
                         " # sky\n  } } }\n";
    };
    editor.reset();
    load(textOf(), isXml ? syntaxes[2].head : syntaxes[0].head, isXml ? "w.x3d" : "w.wrl");
    Image image = field<SFImage>(node("C"), "image");
    for (const size_t pixel : {1u, 3u, 1000u}) image.pixels[3 * pixel] = 0xAB;
    editor->set(node("C"), "image", image);
    words[1] = words[1000] = "0xABF020";
    words[3] = std::to_string(0xAB0203);
    EXPECT_EQ(text(), textOf());
    undoAll();
  }
}

} // namespace
