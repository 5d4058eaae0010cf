"""Tests vv's messages about worlds: each sentence once, hints for pictures that show nothing, the
last line after errors, Scripts."""
import json

from conftest import HEADER, SMALL

SCRIPT = 'Script { url "javascript: function initialize() { var i; for (i = 0; i < 10; ++i) {} }" }\n'


def test_repeated_sentences_are_folded(vv):
    light = "DirectionalLight {{ intensity {} }}\n"
    vv.write(
        "many.wrl",
        HEADER + "".join(light.format(2 + i) for i in range(48)) + "Shape { geometry Box { } }")
    done = vv("many.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0
    assert done.talk.count("is outside of its range") == 1
    assert "many.wrl:2:20: warning: DirectionalLight.intensity: 2 is outside of its range [0,1] and becomes 1 "\
           "(and 47 more like this; -v shows all)" in done.talk
    assert vv("many.wrl", "-v", "-o", "x.png", *SMALL).talk.count("is outside of its range") == 48
    assert vv("many.wrl", "--check").talk.count("is outside of its range") == 48


def test_faces_that_nobody_can_see_are_told_to_authors_only(vv):
    vv.write(
        "flat.wrl", HEADER +
        "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 2 0 0, 0 1 0 ] } "
        "coordIndex [ 0 1 2 -1 0 1 3 -1 ] } }")
    assert "area" not in vv("flat.wrl", "-o", "x.png", *SMALL).talk
    done = vv("flat.wrl", "--check", "--strict")
    assert done.returncode == 0 and "note: IndexedFaceSet: 1 face left out: no area (first at index 0)" in done.talk
    assert "no area" in vv("flat.wrl", "-v", "-o", "x.png", *SMALL).talk


def test_last_line_after_errors(vv):
    vv.write("wrong.wrl", HEADER + "NoSuch { }\nShape { geometry Box { } }\nNeither { }\n")
    done = vv("wrong.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0
    last = done.talk.strip().splitlines()[-1]
    assert last == "vv: 2 errors (wrong.wrl:2, wrong.wrl:4): the picture may lack parts of the world; --strict refuses such a world"
    assert "may lack" not in vv("box.wrl", "-o", "x.png", *SMALL).talk
    strict = vv("wrong.wrl", "--strict", "-o", "x.png", *SMALL)
    assert strict.returncode == 4
    assert strict.talk.endswith("vv: error: nothing is drawn, because of --strict\n")


def test_hints_for_pictures_that_show_nothing(vv):
    vv.write(
        "dark.wrl", HEADER +
        "NavigationInfo { headlight FALSE }\nShape { appearance Appearance { material Material { } } "
        "geometry Box { size 20 20 2 } }")
    talk = vv("dark.wrl", "-o", "x.png", *SMALL).talk
    assert talk == "vv: the picture is black: the world has no light and its headlight is off; --headlight on\n"
    assert vv("dark.wrl", "-o", "x.png", "--headlight", "on", *SMALL).talk == ""
    diffuse = 'appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options "color emission %s" } } '
    vv.write(
        "lamp.wrl", HEADER + "NavigationInfo { headlight FALSE } Viewpoint { position 0 0 5 fieldOfView .1 }\nShape { " +
        diffuse % "0 0 0" + "geometry Box { } }\nTransform { translation 0 3 2 children Shape { " + diffuse % "9 9 9" +
        "geometry Sphere { radius .5 } } }")
    talk = vv("lamp.wrl", "-o", "x.png", "--transport", "direct", *SMALL).talk
    assert talk == ("vv: the picture is black: the world has no lamp, and --transport direct leaves out light of "
                    "emitters on other surfaces; --transport path\n")
    # a silhouette before a background that an option gives
    silhouette = "vv: all shapes in view are black: the world has no light and its headlight is off; --headlight on\n"
    vv.write("small.wrl", HEADER + "NavigationInfo { headlight FALSE }\nShape { appearance Appearance { material Material { } } geometry Box { } }")
    for look in (("--preset", "technical"), ("--background", "white")):
        assert vv("small.wrl", "-o", "x.png", *look, *SMALL).talk == silhouette
        assert vv("small.wrl", "-o", "x.png", "--headlight", "on", *look, *SMALL).talk == ""
    vv.write("lamp.wrl", HEADER + "NavigationInfo { headlight FALSE }\nShape { appearance Appearance { material Material { emissiveColor 1 1 1 } } geometry Box { } }")
    assert vv("lamp.wrl", "-o", "x.png", "--background", "red", *SMALL).talk == ""
    vv.write("away.wrl",
             HEADER + "Viewpoint { orientation 0 1 0 3.14159 }\nShape { geometry Box { } }")
    assert vv("away.wrl", "-o", "x.png",
              *SMALL).talk == "vv: nothing is in view from here: --fit shows all of the world\n"
    assert vv("away.wrl", "-o", "x.png", "--fit", *SMALL).talk == ""
    vv.write("wide.wrl", HEADER + "Transform { translation 1e5 0 0 children DEF A Shape { geometry Sphere { } } } Transform { translation -1e5 1e4 0 children USE A }")
    for look in ((), ("--fit", ), ("--from", "front")):
        assert "smaller than a pixel from here, or" in vv("wide.wrl", "-o", "x.png", *look, *SMALL).talk
    vv.write("empty.wrl", HEADER)
    assert vv(
        "empty.wrl", "-o", "x.png", *SMALL
    ).talk == "vv: warning: empty.wrl: no shape to draw; the picture shows only the background\n"
    assert vv("away.wrl", "-q", "-o", "x.png", *SMALL).talk == ""


def test_scripts_are_counted(vv):
    vv.write("scripts.wrl", HEADER + SCRIPT * 40 + "Shape { geometry Box { } }")
    done = vv("scripts.wrl", "-v", "-o", "x.png", "--stats", "s.json", *SMALL)
    assert "vv: 40 of 40 Scripts started in " in done.talk and "vv: 40 of 40 Scripts run; " in done.talk
    scripts = json.loads((vv.folder / "s.json").read_text())["scripts"]
    assert scripts["scripts"] == scripts["started"] == 40 and scripts["calls"] >= 80 and scripts[
        "seconds"] > 0


def test_script_time_of_a_world_is_limited(vv):
    vv.write(
        "spin.wrl",
        HEADER + 'Script { url "javascript: function initialize() { while (1); }" }\n' * 20 +
        "Shape { geometry Box { } }")
    done = vv("spin.wrl", "-o", "x.png", "--limit", "worldScriptSeconds=1", *SMALL, timeout=60)
    assert done.returncode == 0 and (vv.folder / "x.png").exists()
    assert done.talk.count(
        "limit worldScriptSeconds=1: ") == 1 and "--limit worldScriptSeconds=60" in done.talk


def test_a_script_is_heard_each_time_that_it_prints(vv):
    vv.write(
        "twice.wrl", HEADER +
        'Script { url "javascript: function initialize() { for (var i = 0; i < 3; i++) print(\'again\'); }" }'
    )
    for options in ([], ["-v"]):
        assert vv("twice.wrl", "-o", "x.png", *options, *SMALL).talk.count("again") == 3


def test_errors_are_not_lost_among_other_messages(vv):
    vv.write(
        "prints.wrl", HEADER +
        'Script { url "javascript: function initialize() { for (var i = 0; i < 300; i++) print(\'line \' + i); '
        'undefinedfn(); }" }\nShape { geometry Box { } }')
    for options in ([], ["-q"]):
        assert "undefinedfn" in vv("prints.wrl", "-o", "x.png", *options, *SMALL).talk
    assert "undefinedfn" in vv("prints.wrl", "--check").talk
    assert vv("prints.wrl", "--strict", "-o", "x.png", *SMALL).returncode == 4
    shiny = "Shape { appearance Appearance { material Material { shininess 2 } } geometry Box { } }\n"
    vv.write("thousand.wrl", HEADER + shiny * 1001 + "Shape { geometry Bxo { } }\n")
    assert "Bxo" in vv("thousand.wrl", "-o", "x.png", *SMALL).talk
    quiet = vv("thousand.wrl", "-q", "-o", "x.png", *SMALL).talk.splitlines()
    assert "Bxo" in quiet[0] and not any("more" in line for line in quiet)


def test_names_with_digits_are_not_folded(vv):
    vv.write("names.wrl", HEADER + "".join(f"Node{i} {{ }}\n" for i in range(4)))
    assert all(f"'Node{i}'" in vv("names.wrl", "-o", "x.png", *SMALL).talk for i in range(4))


def test_what_comes_again_in_a_sequence_is_counted(vv):
    vv.write(
        "again.wrl", HEADER +
        "DEF T TimeSensor { loop TRUE }\nDEF S Script { eventIn SFFloat f url \"javascript: function f() { "
        "Browser.createVrmlFromString('Material { shininess 2 }'); }\" }\nROUTE T.fraction_changed TO S.f\nShape { geometry Box { } }"
    )
    talk = vv("again.wrl", "-o", "x.png", "--frames", "0-5", *SMALL).talk
    assert talk.count("outside of its range"
                     ) == 1 and "vv: 5 more like those above came later; -v shows all" in talk


def test_hints_for_worlds_of_one_point_and_too_far_away(vv):
    point = ("Viewpoint {{ {} }} Shape {{ geometry PointSet {{ coord Coordinate {{ point [ 0 0 0 ] "
             "}} }} }}")
    vv.write("seen.wrl", HEADER + point.format(""))
    assert vv("seen.wrl", "-o", "a.png", "--size", "31x31").talk == ""
    vv.write("aside.wrl", HEADER + point.format("position 9 9 0"))
    assert vv("aside.wrl", "-o", "a.png", *SMALL).talk == (
        "vv: all of the world is at one point, and nothing of it is in view from here\n")
    vv.write("far.wrl", HEADER + "Shape { geometry Box { size 1e18 1e18 1e18 } }")
    talk = vv("far.wrl", "--fit", "-o", "a.png", *SMALL).talk
    assert "camera stands farther than 1e17" in talk and "--fit shows" not in talk


def test_looking_for_a_hint_changes_nothing(vv):
    """A world that glows has no light: one more frame tells that its shapes are not black."""
    vv.write("glow.wrl", HEADER + "Shape { appearance Appearance { material Material { emissiveColor 1 1 1 } } geometry Box { } }")
    run = ("glow.wrl", "-o", "g.png", "--background", "white", "--from", "top,left", "--stats", "g.json", *SMALL)
    stats = []
    for quiet in ((), ("-q", )):
        assert vv(*run, *quiet).returncode == 0
        one = json.loads((vv.folder / "g-left.json").read_text())["rays"]
        stats.append({key: value for key, value in one.items() if key != "per_second"})
    assert stats[0] == stats[1]
    for quiet in ((), ("-q", )):
        vv("glow.wrl", "-o", "g.png", "--background", "white", "--record", "g.rec", *SMALL, *quiet)
        stats.append(len((vv.folder / "g.rec").read_bytes()))
    assert abs(stats[2] - stats[3]) < 64


def test_hints_are_given_only_if_they_help(vv):
    black = "Shape {{ appearance Appearance {{ material Material {{ diffuseColor 0 0 0 }} }} geometry Box {{ size 99 99 1 }} }}{}"
    vv.write("black.wrl", HEADER + "Viewpoint { }\n" + black.format(""))
    assert vv("black.wrl", "-o", "x.png", *SMALL).talk == ""
    vv.write("point.wrl", HEADER + "Transform { scale 0 0 0 children Shape { geometry Box { } } }")
    assert "--fit" not in vv("point.wrl", "-o", "x.png", *SMALL).talk
    vv.write(
        "dark.wrl", HEADER +
        "NavigationInfo { headlight FALSE }\nShape { appearance Appearance { material Material { } } "
        "geometry Box { size 20 20 2 } }")
    assert vv("dark.wrl", "-o", "x.png", "--frames", "0-2",
              *SMALL).talk.count("--headlight on") == 1
