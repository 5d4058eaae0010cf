// ecmascript_objects.cpp: the SF objects and VrmlMatrix of ISO/IEC 14772-1 Annex C, one row for
// each constructor, property and method.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

class EcmaScriptObjects : public EcmaRows {};

TEST_P(EcmaScriptObjects, Prints) {
  EcmaWorld r("DEF T Transform { translation 1 2 3 } " +
              EcmaWorld::script(GetParam().declared, GetParam().program));
  EXPECT_EQ(r.takeOutput(), GetParam().printed) << GetParam().program;
}

constexpr EcmaRow rows[] = {
    // C.6.4 SFColor
    {"SFColor_none", "", "print(new SFColor())", "0 0 0"},
    {"SFColor_numbers", "", "print(new SFColor(0.1, 0.5, 1))", "0.1 0.5 1"},
    {"SFColor_fields", "",
     "var c = new SFColor(0.25, 0.5, 1); print(c.r, c.g, c.b, c[0], c[1], c[2])",
     "0.25 0.5 1 0.25 0.5 1"},
    {"SFColor_set", "", "var c = new SFColor(); c.r = 1; c.g = 0.5; c[2] = 0.25; print(c)",
     "1 0.5 0.25"},
    {"SFColor_setHSV", "",
     "var c = new SFColor(); for (var h = 0; h < 420; h += 60) { c.setHSV(h, 1, 0.5); print(c) }",
     "0.5 0 0\n0.5 0.5 0\n0 0.5 0\n0 0.5 0.5\n0 0 0.5\n0.5 0 0.5\n0.5 0 0"},
    {"SFColor_setHSV_grey", "", "var c = new SFColor(); c.setHSV(77, 0, 0.5); print(c)",
     "0.5 0.5 0.5"},
    {"SFColor_getHSV", "",
     "print(new SFColor(1, 0, 0).getHSV()); print(new SFColor(0, 0.5, 0).getHSV()); print(new "
     "SFColor(1, 0, 1).getHSV()); print(new SFColor(1, 1, 1).getHSV().length)",
     "0,1,1\n120,1,0.5\n300,1,1\n3"},
    {"SFColor_toString", "", "print(new SFColor(1, 0, 0).toString() + '!')", "1 0 0!"},
    // Types of X3D (ISO/IEC 19777-1 7.6)
    {"SFColorRGBA", "",
     "var c = new SFColorRGBA(0.1, 0.5, 1, 0.25); c.g = 1; print(c, c.a, c[3], c.getHSV().length)",
     "0.1 1 1 0.25 0.25 0.25 3"},
    {"SFVec4f", "",
     "var v = new SFVec4f(1, 2, 3, 4); print(v.add(v), v.w, v.dot(v)); print(new SFVec4f())",
     "2 4 6 8 4 30\n0 0 0 1"},
    {"SFVec3d", "",
     "var v = new SFVec3d(0.1, 2, 1e100); print(v, v.z == 1e100, v.cross(new SFVec3d(0, 0, 0)))",
     "0.1 2 1e+100 true 0 0 0"},
    {"SFVec2d_field", "field SFVec2d v 3.141592653589793 1",
     "print(v.x == 3.141592653589793); v.y = 0.1; print(v.y, v.length() > 3)", "true\n0.1 true"},
    {"SFDouble_field", "field SFDouble d 0.1 eventOut SFDouble out",
     "print(d * 10 == 1, typeof d); d = 1e300; out = d; print(d, out == d)",
     "true number\n1e+300 true"},
    {"SFMatrix3f", "field SFMatrix3f m 1 2 3 4 5 6 7 8 0.1",
     "print(m[1], m[8], m); m[0] = 7; print(m[0]); print(new SFMatrix4d())",
     "2 0.1 1 2 3 4 5 6 7 8 0.1\n7\n1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"},
    // C.6.5 SFImage
    {"SFImage_none", "", "var i = new SFImage(); print(i.x, i.y, i.comp, i.array.length)",
     "0 0 0 0"},
    {"SFImage_numbers", "",
     "var i = new SFImage(2, 1, 3, new MFInt32(0xff0000, 255)); print(i.x, i.y, i.comp, i.array); "
     "print(i)",
     "2 1 3 [16711680, 255]\n2 1 3 0xFF0000 0xFF"},
    {"SFImage_set", "",
     "var i = new SFImage(); i.x = 1; i.y = 2; i.comp = 1; i.array = new MFInt32(7, 8); print(i)",
     "1 2 1 0x7 0x8"},
    {"SFImage_copies", "",
     "var a = new MFInt32(5), i = new SFImage(1, 1, 1, a); a[0] = 6; print(i.array[0])", "5"},
    // C.6.7 SFRotation
    {"SFRotation_none", "", "print(new SFRotation())", "0 0 1 0"},
    {"SFRotation_numbers", "", "print(new SFRotation(1, 0, 0, 0.5))", "1 0 0 0.5"},
    {"SFRotation_axis", "", "print(new SFRotation(new SFVec3f(0, 1, 0), 0.5))", "0 1 0 0.5"},
    {"SFRotation_from_to", "", "print(new SFRotation(new SFVec3f(2, 0, 0), new SFVec3f(0, 3, 0)))",
     "0 0 1 1.5707964"},
    {"SFRotation_from_same", "",
     "print(new SFRotation(new SFVec3f(2, 0, 0), new SFVec3f(3, 0, 0)).angle)", "0"},
    {"SFRotation_from_opposite", "",
     "var r = new SFRotation(new SFVec3f(1, 0, 0), new SFVec3f(-1, 0, 0)); var v = r.multVec(new "
     "SFVec3f(1, 0, 0)); print(v.x.toFixed(3), Math.abs(v.y) < 1e-9)",
     "-1.000 true"},
    {"SFRotation_fields", "",
     "var r = new SFRotation(1, 2, 3, 4); print(r.x, r.y, r.z, r.angle, r[0], r[3])",
     "1 2 3 4 1 4"},
    {"SFRotation_set", "",
     "var r = new SFRotation(); r.x = 1; r[1] = 2; r.z = 3; r.angle = 4; print(r)", "1 2 3 4"},
    {"SFRotation_getAxis", "", "print(new SFRotation(1, 0, 0, 2).getAxis())", "1 0 0"},
    {"SFRotation_setAxis", "",
     "var r = new SFRotation(1, 0, 0, 2); r.setAxis(new SFVec3f(0, 1, 0)); print(r)", "0 1 0 2"},
    {"SFRotation_inverse", "", "print(new SFRotation(1, 0, 0, 2).inverse())", "1 0 0 -2"},
    {"SFRotation_multiply", "",
     "print(new SFRotation(0, 0, 1, 0.5).multiply(new SFRotation(0, 0, 1, 0.25))); var a = new "
     "SFRotation(1, 0, 0, Math.PI / 2), b = new SFRotation(0, 0, 1, Math.PI / 2); var v = new "
     "SFVec3f(1, 0, 0); var c = a.multiply(b).multVec(v), d = a.multVec(b.multVec(v)); "
     "print(c.subtract(d).length() < 1e-9, c.z.toFixed(3))",
     "0 0 1 0.75\ntrue 1.000"},
    {"SFRotation_multVec", "",
     "var v = new SFRotation(0, 0, 1, Math.PI / 2).multVec(new SFVec3f(1, 0, 5)); "
     "print(v.x.toFixed(3), v.y, v.z)",
     "0.000 1 5"},
    {"SFRotation_slerp", "",
     "var a = new SFRotation(0, 1, 0, 0), b = new SFRotation(0, 1, 0, 1); print(a.slerp(b, 0.25)); "
     "print(a.slerp(b, 0)); print(a.slerp(b, 1))",
     "0 1 0 0.25\n0 1 0 0\n0 1 0 1"},
    {"SFRotation_slerp_short_way", "",
     "print(new SFRotation(0, 0, 1, 3).slerp(new SFRotation(0, 0, 1, -3), 0.5).angle.toFixed(4))",
     "3.1416"},
    {"SFRotation_toString", "", "print('' + new SFRotation(0, 1, 0, 1.5))", "0 1 0 1.5"},
    // C.6.8 SFVec2f
    {"SFVec2f_none", "", "print(new SFVec2f())", "0 0"},
    {"SFVec2f_fields", "", "var v = new SFVec2f(3, 4); print(v.x, v.y, v[0], v[1])", "3 4 3 4"},
    {"SFVec2f_set", "", "var v = new SFVec2f(); v.x = 1; v[1] = 2; print(v)", "1 2"},
    {"SFVec2f_add", "", "print(new SFVec2f(1, 2).add(new SFVec2f(10, 20)))", "11 22"},
    {"SFVec2f_subtract", "", "print(new SFVec2f(1, 2).subtract(new SFVec2f(10, 20)))", "-9 -18"},
    {"SFVec2f_multiply", "", "print(new SFVec2f(1, 2).multiply(3))", "3 6"},
    {"SFVec2f_divide", "", "print(new SFVec2f(1, 2).divide(2))", "0.5 1"},
    {"SFVec2f_dot", "", "print(new SFVec2f(1, 2).dot(new SFVec2f(3, 4)))", "11"},
    {"SFVec2f_length", "", "print(new SFVec2f(3, 4).length())", "5"},
    {"SFVec2f_normalize", "", "print(new SFVec2f(3, 4).normalize())", "0.6 0.8"},
    {"SFVec2f_negate", "", "print(new SFVec2f(3, -4).negate())", "-3 4"},
    {"SFVec2f_toString", "", "print(new SFVec2f(0.1, 1e20).toString())", "0.1 1e+20"},
    // C.6.9 SFVec3f
    {"SFVec3f_none", "", "print(new SFVec3f())", "0 0 0"},
    {"SFVec3f_text", "", "print(new SFVec3f('1', '2', '3'))", "1 2 3"},
    {"SFVec3f_called", "", "print(SFVec3f(1, 2, 3) instanceof SFVec3f)", "true"},
    {"SFVec3f_copy", "", "var a = new SFVec3f(1, 2, 3), b = new SFVec3f(a); a.x = 9; print(b)",
     "1 2 3"},
    {"SFVec3f_fields", "",
     "var v = new SFVec3f(1, 2, 3); print(v.x, v.y, v.z, v[0], v[1], v[2], v['1'], v[3])",
     "1 2 3 1 2 3 2 undefined"},
    {"SFVec3f_set", "", "var v = new SFVec3f(); v.x = 1; v[1] = 2; v.z += 3; v[0]++; print(v)",
     "2 2 3"},
    {"SFVec3f_add", "", "print(new SFVec3f(1, 2, 3).add(new SFVec3f(10, 20, 30)))", "11 22 33"},
    {"SFVec3f_subtract", "", "print(new SFVec3f(1, 2, 3).subtract(new SFVec3f(10, 20, 30)))",
     "-9 -18 -27"},
    {"SFVec3f_multiply", "", "print(new SFVec3f(1, 2, 3).multiply(2))", "2 4 6"},
    {"SFVec3f_divide", "", "print(new SFVec3f(1, 2, 3).divide(2))", "0.5 1 1.5"},
    {"SFVec3f_dot", "", "print(new SFVec3f(1, 2, 3).dot(new SFVec3f(4, 5, 6)))", "32"},
    {"SFVec3f_cross", "", "print(new SFVec3f(1, 0, 0).cross(new SFVec3f(0, 1, 0)))", "0 0 1"},
    {"SFVec3f_length", "", "print(new SFVec3f(2, 3, 6).length())", "7"},
    {"SFVec3f_normalize", "", "print(new SFVec3f(0, 0, 5).normalize(), new SFVec3f().normalize())",
     "0 0 1 0 0 0"},
    {"SFVec3f_negate", "", "print(new SFVec3f(1, -2, 0).negate())", "-1 2 0"},
    {"SFVec3f_unchanged", "",
     "var v = new SFVec3f(1, 2, 3); v.add(v); v.negate(); v.normalize(); print(v)", "1 2 3"},
    {"SFVec3f_equals", "", "var v = new SFVec3f(), w = v; print(v == w, v == new SFVec3f())",
     "true false"},
    // C.6.19 VrmlMatrix
    {"VrmlMatrix_none", "", "print(new VrmlMatrix())", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"},
    {"VrmlMatrix_numbers", "",
     "var m = new VrmlMatrix(1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16); print(m[0][1], m[3][0], m)",
     "2 13 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16"},
    {"VrmlMatrix_set", "", "var m = new VrmlMatrix(); m[3][1] = 5; m[0][0] += 1; print(m)",
     "2 0 0 0 0 1 0 0 0 0 1 0 0 5 0 1"},
    {"VrmlMatrix_setTransform", "",
     "var m = new VrmlMatrix(); m.setTransform(new SFVec3f(1, 2, 3)); print(m); "
     "m.setTransform(null, null, new SFVec3f(2, 3, 4)); print(m); m.setTransform(new SFVec3f(5, 0, "
     "0), new SFRotation(0, 0, 1, Math.PI / 2), new SFVec3f(2, 2, 2), new SFRotation(), new "
     "SFVec3f(1, 0, 0)); var v = m.multVecMatrix(new SFVec3f(2, 0, 0)); print(v.x.toFixed(3), "
     "v.y.toFixed(3), v.z.toFixed(3))",
     "1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1\n2 0 0 0 0 3 0 0 0 0 4 0 0 0 0 1\n6.000 2.000 0.000"},
    {"VrmlMatrix_getTransform", "",
     "var m = new VrmlMatrix(), t = new SFVec3f(), r = new SFRotation(), s = new SFVec3f(); "
     "m.setTransform(new SFVec3f(1, 2, 3), new SFRotation(0, 1, 0, 0.5), new SFVec3f(2, 3, 4)); "
     "m.getTransform(t, r, s); print(t); print(r); print(s)",
     "1 2 3\n0 1 0 0.5\n2 3 4"},
    {"VrmlMatrix_inverse", "",
     "var m = new VrmlMatrix(); m.setTransform(new SFVec3f(1, 2, 3), null, new SFVec3f(2, 2, 2)); "
     "print(m.inverse()); print(m.multRight(m.inverse()))",
     "0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 -0.5 -1 -1.5 1\n1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"},
    {"VrmlMatrix_transpose", "",
     "print(new VrmlMatrix(1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16).transpose())",
     "1 5 9 13 2 6 10 14 3 7 11 15 4 8 12 16"},
    {"VrmlMatrix_multLeft", "",
     "var a = new VrmlMatrix(), b = new VrmlMatrix(); a.setTransform(new SFVec3f(1, 0, 0)); "
     "b.setTransform(null, null, new SFVec3f(2, 2, 2)); print(a.multLeft(b)[3][0], "
     "b.multLeft(a)[3][0])",
     "1 2"},
    {"VrmlMatrix_multRight", "",
     "var a = new VrmlMatrix(), b = new VrmlMatrix(); a.setTransform(new SFVec3f(1, 0, 0)); "
     "b.setTransform(null, null, new SFVec3f(2, 2, 2)); print(a.multRight(b)[3][0], "
     "b.multRight(a)[3][0])",
     "2 1"},
    {"VrmlMatrix_multVecMatrix", "",
     "var m = new VrmlMatrix(); m.setTransform(new SFVec3f(1, 2, 3)); print(m.multVecMatrix(new "
     "SFVec3f(1, 1, 1)))",
     "2 3 4"},
    {"VrmlMatrix_multMatrixVec", "",
     "var m = new VrmlMatrix(); m[0][3] = 5; print(m.multMatrixVec(new SFVec3f(1, 1, 1)))",
     "6 1 1"},
    // C.6.6 SFNode
    {"SFNode_text", "",
     "var n = new SFNode('Transform { translation 4 5 6 }'); print(n.translation, n)",
     "4 5 6 Transform { }"},
    {"SFNode_field",
     "directOutput TRUE field SFNode t USE T field SFNode u USE T field SFNode n NULL",
     "print(t == u, t != null, n, t.translation, t.translation_changed, t.nothing); t.translation "
     "= new SFVec3f(7, 8, 9); print(t.translation); t.set_translation.x = 1; "
     "print(t.translation_changed, t)",
     "true true null 1 2 3 1 2 3 undefined\n7 8 9\n1 8 9 DEF T Transform { }"},
    {"SFNode_copy", "field SFNode t USE T", "print(new SFNode(t) == t, t instanceof SFNode)",
     "true true"},
    {"SFNode_none", "", "print(new SFNode())", "NULL"},
    {"Floats",
     "field SFFloat f 0.1 field SFVec3f v 0.1 -1e-7 3.3 field MFFloat m [0.7, 16777217] field "
     "SFColor c 0.3 0 1",
     "print(f, v.x, v.y, v.z, m[0], m[1], c.r, f == 0.1); f = 1 / 3; print(f); v.x = 2 / 3; "
     "print(v.x); v = new SFVec3f(1 / 3, 0, 0); print(v.x)",
     "0.1 0.1 -1e-7 3.3 0.7 16777216 0.3 true\n0.33333334\n0.6666667\n0.33333334"},
    // SFString, SFTime, SFBool and numbers are values of the language (C.6.2)
    {"Natives",
     "field SFString s \"abc\" field SFTime t 2.5 field SFBool b TRUE field SFInt32 i 7 field "
     "SFFloat f 0.5",
     "print(typeof s, s.length, typeof t, t, typeof b, b, typeof i, i + 1, f * 2)",
     "string 3 number 2.5 boolean true number 8 1"},
};

INSTANTIATE_TEST_SUITE_P(AnnexC, EcmaScriptObjects, testing::ValuesIn(rows), rowName);

} // namespace
} // namespace xvrml
