// ecmascript_2020.cpp: programs of ECMAScript 2020 and later with the objects of Annex C. Skipped
// where the engine runs ECMAScript 5.1 only.
#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

constexpr const char* header = "#X3D V4.0 utf8\nPROFILE Immersive ";

class EcmaNewRows : public EcmaRows {
 protected:
  void SetUp() override {
    if (!hasEcmaScript() || !runsEs2020()) GTEST_SKIP() << "the engine runs ECMAScript 5.1";
  }
};

TEST_P(EcmaNewRows, Prints) {
  EcmaWorld r(EcmaWorld::script(GetParam().declared, GetParam().program));
  EXPECT_EQ(r.takeOutput(), GetParam().printed) << GetParam().program;
}

constexpr EcmaRow rows[] = {
    {"LetAndConst", "", "let a = 1; { let a = 2; const b = a; print(b) } print(a)", "2\n1"},
    {"LetInLoops", "",
     "let f = []; for (let i = 0; i < 3; i++) f.push(() => i); print(f.map(g => g()))", "0,1,2"},
    {"Templates", "field SFVec3f at 1 2 3",
     "const n = 3; print(`it's ${`n = ${n}`} at ${at}`); print(`{${{ a: 1 }.a}}`)",
     "it's n = 3 at 1 2 3\n{1}"},
    {"TemplatesKeepTheirText", "field SFVec3f at 1 2 3", "print(`x = at; return at`)",
     "x = at; return at"},
    {"TaggedTemplates", "",
     "const tag = (s, ...v) => s.raw.join('|') + v; print(tag`a${1}\\b${2}`)", "a|\\b|1,2"},
    {"Classes", "",
     "class Ball { #r = 2; static made = 0; constructor(x) { this.x = x; Ball.made++ } get area() "
     "{ return this.#r * this.x } } class Big extends Ball { get area() { return super.area * 10 } "
     "} print(new Ball(1).area, new Big(3).area, Ball.made)",
     "2 60 2"},
    {"ClassOfATuple", "",
     "class Place extends SFVec3f { twice() { return this.multiply(2) } } const p = new Place(1, "
     "2, "
     "3); print(p, p.twice(), p instanceof Place, p instanceof SFVec3f)",
     "1 2 3 2 4 6 true true"},
    {"ClassOfAList", "",
     "class Numbers extends MFFloat { sum() { let s = 0; for (const x of this) s += x; return s } "
     "} "
     "const n = new Numbers(1, 2, 3); n.push(4); print(n, n.sum(), n.length, n instanceof Numbers)",
     "[1, 2, 3, 4] 10 4 true"},
    {"ClassOfANodeIsTheNode", "",
     "class N extends SFNode {} const g = new N('Group { }'); print(g.getNodeTypeName())", "Group"},
    {"DestructuredTuple", "field SFVec3f at 1 2 3",
     "const { x, y: height, w = 7 } = at; print(x, height, w)", "1 2 7"},
    {"DestructuredList", "field MFVec3f m [ 1 2 3, 4 5 6, 7 8 9 ]",
     "const [a, , { z }] = m; print(a, z)", "1 2 3 9"},
    {"SpreadAndRest", "field MFFloat f [ 3, 1, 2 ]",
     "print(Math.max(...f), [...f].sort().join()); const g = (a, ...b) => b.length; "
     "print(g(...f), { ...{ a: 1 } }.a)",
     "3 1,2,3\n2 1"},
    {"ForOf", "field MFVec3f m [ 1 2 3, 4 5 6 ]",
     "for (const p of m) p.x = 0; print(m); for (const [i, p] of [...m].entries()) print(i, p.y)",
     "[0 2 3, 0 5 6]\n0 2\n1 5"},
    {"ForOfNodes", "field MFNode n [ Group { } Transform { } ]",
     "for (const one of n) print(one.getNodeTypeName())", "Group\nTransform"},
    {"Generators", "",
     "function* ring(n) { for (let i = 0; i < n; i++) yield new SFRotation(0, 1, 0, i) } "
     "print(new MFRotation([...ring(2)]))",
     "[0 1 0 0, 0 1 0 1]"},
    {"MapsAndSetsOfNodes", "field MFNode n [ DEF A Group { } USE A Group { } ]",
     "const names = new Map(); for (const one of n) names.set(one, one.getNodeName()); "
     "print(names.size, names.get(n[1]), new Set(n).size)",
     "2 A 2"},
    {"OptionalChains", "field SFNode n NULL",
     "print(n?.children?.length ?? 'none', null ?? 1, 0 ?? 2)", "none 1 0"},
    {"DefaultsAndExponents", "field SFVec3f at 1 2 3",
     "const f = (p = at, n = 2) => p.x ** n + 2 ** 10; print(f(), f({ x: 3 }))", "1025 1033"},
    {"BigIntegers", "", "print(2n ** 64n, typeof 1n)", "18446744073709551616 bigint"},
    {"RegularExpressions", "",
     "const m = /(?<year>\\d{4})-(?<=-)(?<month>\\d\\d)/u.exec('2020-06'); "
     "print(m.groups.year, m.groups.month, 'aXbX'.replaceAll('X', '.'))",
     "2020 06 a.b."},
    {"ArraysAndTexts", "field MFInt32 f [ 5, 6 ]",
     "print(f.includes(6), f.find(x => x > 5), [1, [2, [3]]].flat(Infinity), '7'.padStart(3, '0'), "
     "Object.entries({ a: 1 }), Array.from(f, x => x * 2), Object.fromEntries([['b', 2]]).b)",
     "true 6 1,2,3 007 a,1 10,12 2"},
    {"TypedArrays", "field MFFloat f []",
     "f = Float32Array.of(0.5, 1.5); print(f); f = new Uint8Array([1, 2]); print(f, "
     "new MFInt32(new Int16Array(2)))",
     "[0.5, 1.5]\n[1, 2] [0, 0]"},
    {"StrictPrograms", "field SFInt32 n 1 eventOut SFVec3f out",
     "'use strict'; n += 1; out = new SFVec3f(1, 2, 3); out.x = n; print(n, out);"
     "try { undeclared = 1 } catch (e) { print(e.name) }",
     "2 2 2 3\nReferenceError"},
    {"ConstantsAreCopies", "field SFVec3f at 1 2 3 field MFFloat f [ 1 ]",
     "const v = at, g = () => f; v.x = 9; g()[0] = 9; print(at, f)", "1 2 3 [1]"},
    {"LabelsOfTypes", "",
     "print(typeof SFVec3f, `${new SFVec3f()}`, new SFVec3f().constructor.name)",
     "function 0 0 0 SFVec3f"},
    {"ProgramsOf1998", "",
     "<!--\nvar of = 2, async = 3, get = 4; with ({ q: 5 }) print(of + async + get + q, 010)\n"
     "if (TRUE) { function inner() { return inner.caller === null } } print(typeof inner)\n// -->",
     "14 8\nfunction"},
};
INSTANTIATE_TEST_SUITE_P(Es2020, EcmaNewRows, testing::ValuesIn(rows), rowName);

class EcmaNew : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasEcmaScript() || !runsEs2020()) GTEST_SKIP() << "the engine runs ECMAScript 5.1";
  }
};

// A newcomer's Script: everything at the top is a constant.
TEST_F(EcmaNew, FunctionsMayBeConstants) {
  EcmaWorld r(header +
              EcmaWorld::script("inputOnly SFFloat height inputOutput SFVec3f position 0 1 0 "
                                "outputOnly SFVec3f moved",
                                "const up = new SFVec3f(0, 1, 0);\n"
                                "class Lift { constructor(from) { this.from = from }\n"
                                "  at(t) { return this.from.add(up.multiply(t)) } }\n"
                                "let lift;\n"
                                "const initialize = () => { lift = new Lift(position) };\n"
                                "const height = (value, time) => { moved = lift.at(value) };\n"
                                "const set_position = p => print(`position ${p}`);\n"
                                "let eventsProcessed = () => print('processed');"));
  r.log("S", "moved");
  r.set("S", "height", 2.0f);
  EXPECT_EQ(r.take(), Log{"0 S.moved 0 3 0"});
  r.set("S", "position", Vec3f{4, 5, 6});
  EXPECT_EQ(r.takeOutput(), "processed\nposition 4 5 6\nprocessed");
}

TEST_F(EcmaNew, WhatFollowsAnAwaitBelongsToTheCall) {
  EcmaWorld r(EcmaWorld::script("eventIn SFBool go eventIn SFBool come eventOut SFInt32 out",
                                "let arrive; const arrival = new Promise(r => arrive = r);\n"
                                "async function go() {\n"
                                "  out = await 1;\n"
                                "  out = 10 * await arrival;\n"
                                "}\n"
                                "const come = () => arrive(7);"));
  r.log("S", "out");
  r.set("S", "go", true);
  EXPECT_EQ(r.take(), Log{"0 S.out 1"});
  r.set("S", "come", true);
  EXPECT_EQ(r.take(), Log{"0 S.out 70"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(EcmaNew, ARejectionThatNobodyHandlesIsAnError) {
  EcmaWorld r(
      EcmaWorld::script("eventIn SFBool go eventIn SFBool ask",
                        "async function fails() {\n  await 0;\n  throw new Error('late');\n}\n"
                        "function go() { fails(); fails().catch(e => print('caught')) }\n"
                        "function ask() { print('alive') }"));
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "caught\n4: Script S: Error: late (in fails)");
  r.set("S", "ask", true);
  EXPECT_EQ(r.takeOutput(), "alive");
}

TEST_F(EcmaNew, SyntaxErrorsNameTheirLine) {
  EcmaWorld r(EcmaWorld::script("", "class A {\n  constructor( { }\n}"));
  EXPECT_EQ(r.takeOutput().find("4: Script S: SyntaxError: "), 0u);
  EcmaWorld module(EcmaWorld::script("", "import { a } from 'b';"));
  EXPECT_EQ(module.takeOutput().find("2: Script S: SyntaxError: "), 0u);
}

// No symbol, key or proxy leads to what the objects of the browser hide.
TEST_F(EcmaNew, HiddenPropertiesStayHidden) {
  EcmaWorld r(EcmaWorld::script(
      "field MFVec3f m [ 1 2 3 ]",
      "const all = [new SFVec3f(), m, m[0], new SFNode('Group { }'), Browser, new VrmlMatrix(),"
      " new MFString('a'), new SFImage(), Browser.createVrmlFromString('Group { }')];\n"
      "for (let o of all) for (; o; o = Object.getPrototypeOf(o)) for (const key of "
      "Reflect.ownKeys(o)) if (typeof key == 'symbol' && !(key.description || '').startsWith("
      "'Symbol.')) print(String(key));\n"
      "const seen = []; const watch = new Proxy({}, { get(t, key) { seen.push(typeof key) } });\n"
      "try { SFVec3f.prototype.add.call(watch, watch) } catch (e) { print(e.name, seen.length) }\n"
      "print(new Proxy(new SFVec3f(1, 2, 3), {}).y);\n"
      "try { m[0] = new Proxy(new SFVec3f(1, 2, 3), {}) } catch (e) { print(e.name) }\n"
      "print(typeof WeakRef, typeof FinalizationRegistry, typeof SharedArrayBuffer, typeof std, "
      "typeof os);"));
  EXPECT_EQ(r.takeOutput(),
            "TypeError 0\nundefined\nTypeError\nundefined undefined undefined undefined undefined");
}

// Two lists that inherit from each other's type ask each other for ever.
TEST_F(EcmaNew, CirclesOfProxiesAreAnError) {
  EcmaWorld r(EcmaWorld::script("", "const m = new MFVec3f(); Object.setPrototypeOf(m, {});"
                                    "Object.setPrototypeOf(MFVec3f.prototype, m);"
                                    "try { m.nothing } catch (e) { print(e.message) }"));
  EXPECT_EQ(r.takeOutput(), "stack overflow");
}

// Setters of the program's do not see what the engine keeps in arrays of its own.
TEST_F(EcmaNew, PrototypesOfTheProgramDoNotReachTheBrowser) {
  EcmaWorld r(EcmaWorld::script(
      "eventIn SFBool go field MFString texts [] field MFNode nodes [] eventOut MFString out",
      "for (let i = 0; i < 40; i++) Object.defineProperty(Array.prototype, i, "
      "{ set(v) { print('seen') }, get() { return 5 }, configurable: true });\n"
      "function go() { texts = new MFString('a', 'b'); texts[2] = 'c'; nodes = "
      "Browser.createVrmlFromString('Group { } Group { }'); out = texts; print(nodes.length) }"));
  r.log("S", "out");
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "2");
  EXPECT_EQ(r.take(), Log{"0 S.out [a, b, c]"});
}

// C.6.2 holds behind a template with an escaped ${ and within one that is none.
TEST_F(EcmaNew, AssignmentsInTemplatesCopy) {
  EcmaWorld r(EcmaWorld::script("field MFFloat f [ 1 2 ]",
                                "var t = `cost \\${`; var w = f; f[0] = 9; print(w[0], t);\n"
                                "var v; `${ v = f }`; f[0] = 5; print(v[0], `\\${a = p}`);"));
  EXPECT_EQ(r.takeOutput(), "1 cost ${\n9 ${a = p}");
}

TEST_F(EcmaNew, AnArrayPrototypeWithElementsDoesNoHarm) {
  EcmaWorld r(EcmaWorld::script("", "Array.prototype[0] = {}; print('fine');"));
  EXPECT_EQ(r.takeOutput(), "fine");
}

TEST_F(EcmaNew, ALoopWithoutCallsIsStoppedInThisProcess) {
  for (const char* loop :
       {"for (;;);", "while (1) { try { for (;;); } catch (e) {} }",
        "try { for (;;); } finally { for (;;); }", "(async () => { await 1; for (;;); })()",
        "function f() { Promise.resolve().then(f) } f()", "/^(a*)*b$/.test('a'.repeat(60))",
        "[...(function*() { for (;;) yield 1 })()]",
        "new Map([[1, 2]]).forEach((v, k, m) => { for (;;) m.set(k++, v) })"}) {
    BrowserOptions options;
    options.scriptSteps = 2'000'000;
    options.scriptMemory = 64 << 20;
    EcmaWorld r(EcmaWorld::script("eventIn SFBool go eventOut SFInt32 out",
                                  std::string("function go() { out = 1; ") + loop + " }"),
                options);
    r.set("S", "go", true);
    EXPECT_EQ(r.messages().size(), 1u) << loop;
  }
}

// A program that keeps most of its memory goes on while something can be collected.
TEST_F(EcmaNew, CirclesNearTheLimitAreCollected) {
  BrowserOptions options;
  options.scriptMemory = 16 << 20;
  options.scriptSeconds = 60;
  EcmaWorld r(EcmaWorld::script("",
                                "const kept = []; for (let i = 0; i < 60000; i++) kept.push([i]);"
                                "for (let i = 0; i < 200000; i++) { const o = {}; o.o = [o] }"
                                "print(kept.length)"),
              options);
  EXPECT_EQ(r.takeOutput(), "60000");
}

// A program cannot go on with what its compiler had no memory for.
TEST_F(EcmaNew, MissingMemoryEndsAProgram) {
  BrowserOptions options;
  options.scriptMemory = 4 << 20;
  EcmaWorld r(EcmaWorld::script(
                  "eventIn SFBool go",
                  "function go() { const kept = []; for (;;) try { kept.push(eval('(function() { "
                  "return ' + JSON.stringify('x'.repeat(kept.length % 999)) + ' })')) } catch (e) "
                  "{ print(e) } }"),
              options);
  r.set("S", "go", true);
  r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "2: Script S: out of memory; the Script ends");
}

// Nodes that only a circle of the program's objects refers to are released.
TEST_F(EcmaNew, CirclesWithNodesAreCollected) {
  BrowserOptions options;
  options.scriptMemory = 8 << 20;
  options.scriptSeconds = 60;
  EcmaWorld r(EcmaWorld::script(
                  "eventIn SFBool go",
                  "function go() { for (let i = 0; i < 5000; i++) { const o = { n: new SFNode("
                  "'Transform { }') }; o.self = [o]; o.n.own = o } print('done') }"),
              options);
  for (int i = 0; i < 4; ++i) r.set("S", "go", true);
  EXPECT_EQ(r.takeOutput(), "done\ndone\ndone\ndone");
}

} // namespace
} // namespace xvrml
