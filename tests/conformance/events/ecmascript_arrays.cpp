// ecmascript_arrays.cpp: the MF objects of ISO/IEC 14772-1 Annex C (C.6.10 to C.6.18):
// constructors, length, elements, conversions.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

class EcmaScriptArrays : public EcmaRows {};

TEST_P(EcmaScriptArrays, Prints) {
  EcmaWorld r("DEF T Transform { children [ DEF A Group { } DEF B Group { } ] } " +
              EcmaWorld::script(GetParam().declared, GetParam().program));
  EXPECT_EQ(r.takeOutput(), GetParam().printed) << GetParam().program;
}

constexpr EcmaRow rows[] = {
    // Types of X3D (ISO/IEC 19777-1 7.6)
    {"MFBool", "field MFBool f [ TRUE FALSE ]",
     "print(f[0], f[1], f.length, f); f[3] = true; print(f); print(new MFBool(0, 'x', true))",
     "true false 2 [TRUE, FALSE]\n[TRUE, FALSE, FALSE, TRUE]\n[FALSE, TRUE, TRUE]"},
    {"MFDouble", "field MFDouble f [ 0.1 1e300 ]",
     "print(f[0] * 10 == 1, f); f[2] = 3; print(f.length, new MFDouble(f)[1] == 1e300)",
     "true [0.1, 1e+300]\n3 true"},
    {"MFVec4f", "field MFVec4f f [ 1 2 3 4 ]",
     "f[0].w = 5; f[2] = new SFVec4f(1, 1, 1, 1); print(f)", "[1 2 3 5, 0 0 0 1, 1 1 1 1]"},
    {"MFMatrix3d", "field MFMatrix3d f [ ]", "f.length = 1; f[0][1] = 0.1; print(f)",
     "[1 0.1 0 0 1 0 0 0 1]"},
    {"MFColorRGBA", "", "var c = new MFColorRGBA(new SFColorRGBA(1, 0, 0, 0.5)); print(c[0].a, c)",
     "0.5 [1 0 0 0.5]"},
    {"MFImage", "field MFImage f [ 1 1 1 7, 2 1 1 1 2 ]",
     "print(f.length, f[1]); f[0] = f[1]; f.length = 3; print(f)",
     "2 2 1 1 0x1 0x2\n[2 1 1 0x1 0x2, 2 1 1 0x1 0x2, 0 0 0]"},
    {"MFColor", "",
     "var m = new MFColor(new SFColor(1, 0, 0), new SFColor(0, 0.5, 0)); print(m, m.length, "
     "m[1].g)",
     "[1 0 0, 0 0.5 0] 2 0.5"},
    {"MFFloat", "", "var m = new MFFloat(1, 0.25, '3'); print(m, m.length, m[1])",
     "[1, 0.25, 3] 3 0.25"},
    {"MFInt32", "", "var m = new MFInt32(1, 2.9, -3.9, true); print(m, m.length)",
     "[1, 2, -3, 1] 4"},
    {"MFNode", "", "var m = new MFNode(new SFNode('Group { }'), null); print(m, m.length, m[1])",
     "[Group { }, NULL] 2 null"},
    {"MFRotation", "", "var m = new MFRotation(new SFRotation(1, 0, 0, 2)); m.length = 2; print(m)",
     "[1 0 0 2, 0 0 1 0]"},
    {"MFString", "", "var m = new MFString('a', 5, 'c\"d'); print(m, m.length, m[2], typeof m[1])",
     "[\"a\", \"5\", \"c\\\"d\"] 3 c\"d string"},
    {"MFTime", "", "var m = new MFTime(1, 2.5, 1e10); print(m, m.length, m[2])",
     "[1, 2.5, 10000000000] 3 10000000000"},
    {"MFVec2f", "",
     "var m = new MFVec2f(new SFVec2f(1, 2)); m[1] = new SFVec2f(3, 4); print(m, m.length)",
     "[1 2, 3 4] 2"},
    {"MFVec3f", "", "var m = new MFVec3f(new SFVec3f(1, 2, 3)); print(m, m[0], m[0].y, m[0][2])",
     "[1 2 3] 1 2 3 2 3"},
    {"empty", "",
     "print(new MFColor(), new MFFloat().length, new MFNode(), new MFString().length, new "
     "MFVec3f())",
     "[] 0 [] 0 []"},
    {"of_array", "",
     "print(new MFFloat([1, 2, 3]), new MFVec2f([[1, 2], [3, 4]]), new MFFloat(new MFInt32(1, 2)))",
     "[1, 2, 3] [1 2, 3 4] [1, 2]"},
    {"grow", "", "var m = new MFFloat(); m[3] = 1; print(m, m.length)", "[0, 0, 0, 1] 4"},
    {"grow_texts", "", "var m = new MFString(); m[1] = 'x'; print(m)", "[\"\", \"x\"]"},
    {"grow_nodes", "", "var m = new MFNode(); m[1] = new SFNode('Group { }'); print(m)",
     "[NULL, Group { }]"},
    {"grow_one_by_one", "",
     "var m = new MFInt32(); for (var i = 0; i < 1000; i++) m[i] = i; print(m.length, m[0], "
     "m[999])",
     "1000 0 999"},
    {"length_set", "",
     "var m = new MFInt32(1, 2, 3); m.length = 1; print(m); m.length = 3; print(m)",
     "[1]\n[1, 0, 0]"},
    {"length_texts", "", "var m = new MFString('a', 'b'); m.length = 1; m.length = 2; print(m)",
     "[\"a\", \"\"]"},
    {"beyond", "", "var m = new MFInt32(1); print(m[1], m[-1], m[0.5], m[4e9], 0 in m, 1 in m)",
     "undefined undefined undefined undefined true false"},
    {"element_of_nothing", "", "var m = new MFInt32(1); try { m[-1] = 1 } catch (e) { print(e) }",
     "RangeError: MFInt32: no element -1"},
    {"too_long", "", "var m = new MFInt32(); try { m[4e9] = 1 } catch (e) { print(e) }",
     "RangeError: MFInt32: more than 16000000 elements"},
    {"bad_length", "", "var m = new MFInt32(); try { m.length = -1 } catch (e) { print(e) }",
     "RangeError: MFInt32: length -1"},
    {"element_type", "", "var m = new MFVec3f(); try { m[0] = 5 } catch (e) { print(e) }",
     "TypeError: MFVec3f: expected SFVec3f, got number 5"},
    // C.6.2: assigning an element to a variable, or a value to an element, copies.
    {"assigned_copies", "",
     "var v = new SFVec3f(1, 2, 3), m = new MFVec3f(v); v.x = 9; print(m); m[0] = v; v.x = 5; "
     "print(m)",
     "[1 2 3]\n[9 2 3]"},
    {"swap", "",
     "var m = new MFVec3f(new SFVec3f(1, 1, 1), new SFVec3f(2, 2, 2)); var t = m[0]; m[0] = m[1]; "
     "m[1] = t; print(m)",
     "[2 2 2, 1 1 1]"},
    {"component", "",
     "var m = new MFVec3f(new SFVec3f(1, 2, 3)); m[0].x = 7; m[0][1] = 8; m[0].z += 1; print(m)",
     "[7 8 4]"},
    {"component_beyond", "",
     "var m = new MFVec3f(); for (var i = 0; i < 3; i++) { m[i].x = i; m[i].z = 9 } print(m); "
     "m[5]; print(m.length)",
     "[0 0 9, 1 0 9, 2 0 9]\n3"},
    {"component_hsv", "", "var m = new MFColor(new SFColor()); m[0].setHSV(120, 1, 1); print(m)",
     "[0 1 0]"},
    {"reference", "", "var m = new MFInt32(1), n = m; n[0] = 2; print(m, m == n)", "[2] true"},
    {"join", "",
     "print(new MFInt32(1, 2, 3).join('-'), new MFVec2f(new SFVec2f(1, 2), new SFVec2f(3, "
     "4)).join(';'))",
     "1-2-3 1 2;3 4"},
    {"push", "", "var m = new MFInt32(1); m.push(2, 3); print(m, m.length); print(m.pop(), m)",
     "[1, 2, 3] 3\n3 [1, 2]"},
    {"shift", "", "var m = new MFInt32(1, 2, 3); m.unshift(0); print(m.shift(), m.shift(), m)",
     "0 1 [2, 3]"},
    {"sort", "", "var m = new MFFloat(3, 1, 2); m.sort(); m.reverse(); print(m, m.indexOf(1))",
     "[3, 2, 1] 2"},
    {"slice", "",
     "var m = new MFVec3f(); m[2] = new SFVec3f(1, 2, 3); var n = new MFVec3f(m.slice(1, 3)); "
     "print(n)",
     "[0 0 0, 1 2 3]"},
    {"toString", "", "print('' + new MFVec3f(new SFVec3f(1, 2, 3)), new MFFloat(0.1).toString())",
     "[1 2 3] [0.1]"},
    {"fields",
     "field MFString s [\"a\", \"b\"] field MFInt32 i [3, 4] field MFTime t 5 field MFRotation r 1 "
     "0 0 2 field MFNode n []",
     "print(s, i, t, r, n, s.length, i[1])", "[\"a\", \"b\"] [3, 4] [5] [1 0 0 2] [] 2 4"},
    {"nodes", "field SFNode t USE T field SFNode a USE A",
     "print(t.children.length, t.children[0] == a, t.children[1])", "2 true DEF B Group { }"},
    {"loop", "field MFVec3f p [1 2 3, 4 5 6]",
     "var s = 0; for (var i = 0; i < p.length; i++) s += p[i].x + p[i].y; print(s)", "12"},
};

INSTANTIATE_TEST_SUITE_P(AnnexC, EcmaScriptArrays, testing::ValuesIn(rows), rowName);

} // namespace
} // namespace xvrml
