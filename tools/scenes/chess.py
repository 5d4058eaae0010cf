"""examples/scenes/chess.wrl: a full chess set on its board. A square is one unit; y = 0 is the top
of the squares; rank 1 is at z = 3.5, the file a at x = -3.5. chess.tcl moves the pieces by the
names that are given here."""
import math

from scenes.knight import knight_head
from scenes.parts import HEADER, aim, arc, at, box, curve, lathe, mesh, shape, tube, viewpoint

FOOT = .004  # gap of air between the pieces and the board
STEPS = 56
ORDER = ["rook", "knight", "bishop", "queen", "king", "bishop", "knight", "rook"]


def foot(radius):
    """Returns the profile of a base from the centre of the bottom to the neck: plinth, torus,
    fillet."""
    return ([(0, FOOT),
             (radius - .012, FOOT)] + arc(radius - .012, FOOT + .012, .012, .012, -90, 0, 3) +
            [(radius, .055)] + arc(radius - .02, .055, .02, .02, 0, 90, 3) +
            arc(radius - .05, .115, .045, .04, -90, 90, 8) + [(radius - .075, .158)])


def collar(radius, low, high):
    """Returns the profile of a disc around the neck, with a round edge."""
    r = (high - low) / 2
    return arc(radius - r, low + r, r, r, -90, 90, 6)


def pawn():
    return (foot(.3) + curve([(.21, .165), (.145, .23), (.105, .34), (.09, .47)], 5) +
            collar(.165, .475, .515) + [(.085, .53)] + arc(0, .655, .155, .155, -56, 90, 14))


def rook():
    return (foot(.34) + curve([(.25, .165), (.205, .25), (.185, .4),
                               (.178, .6)], 5) + collar(.235, .605, .655) +
            curve([(.19, .665), (.205, .7), (.245, .74)], 4) + [(.25, .75), (.25, .86), (.165, .86),
                                                                (.165, .78), (0, .775)])


def bishop():
    return (foot(.325) + curve([(.225, .165), (.16, .25), (.115, .42), (.09, .7)], 6) +
            collar(.2, .7, .735) + [(.1, .745)] + collar(.15, .755, .785) + [(.085, .80),
                                                                             (.08, .84), (0, .84)])


def queen():
    return (foot(.36) + curve([(.255, .165), (.185, .26), (.13, .5),
                               (.105, .95)], 7) + collar(.235, .95, .99) + [(.125, 1.0)] +
            collar(.185, 1.01, 1.045) + curve([(.105, 1.055), (.115, 1.13), (.155, 1.24),
                                               (.215, 1.33)], 6) + [(.2, 1.345), (.155, 1.34)] +
            curve([(.15, 1.335), (.10, 1.38), (0, 1.4)], 4))


def king():
    return (foot(.37) + curve([(.265, .165), (.195, .27), (.14, .55),
                               (.115, 1.06)], 7) + collar(.245, 1.06, 1.10) +
            [(.135, 1.11)] + collar(.195, 1.12, 1.16) + curve([(.115, 1.17), (.125, 1.25),
                                                               (.16, 1.36), (.205, 1.45)], 6) +
            [(.2, 1.465)] + curve([(.18, 1.475), (.1, 1.525), (0, 1.54)], 4))


def merlons():
    """Returns six blocks on the rook's wall; they overlap it a little."""
    points, faces = [], []
    for k in range(6):
        middle, half, rows = k * math.pi / 3, .36, []
        for i in range(7):
            a = middle - half + 2 * half * i / 6
            rows.append([(r * math.cos(a), y, -r * math.sin(a))
                         for r, y in ((.169, .85), (.246, .85), (.246, .945), (.169, .945))])
        p, f = tube(rows, caps=False)
        f += [(0, 3, 2, 1), tuple(24 + i for i in range(4))]
        f = [tuple(reversed(face)) for face in f]
        faces += [tuple(i + len(points) for i in face) for face in f]
        points += p
    return mesh(points, faces, .5)


def mitre():
    """Returns the bishop's head: an ellipsoid with a pointed tip and a slanting cut in front. The
    rows are circles of latitude about the cut's own axis, so that the cut's edges are rows."""
    columns, lean = 40, .7
    rows = []
    latitudes = [(-math.pi / 2 + math.pi * i / 18, 1) for i in range(1, 18)]
    low, high = .16, .27
    latitudes = [x for x in latitudes if not low - .06 < x[0] < high + .06] + [(low - .005, 1),
                                                                               (low, 0), (high, 0),
                                                                               (high + .005, 1)]
    for latitude, outside in sorted(latitudes):
        row = []
        for i in range(columns):
            a = 2 * math.pi * i / columns
            r = 1.0
            if not outside:  # the cut is deepest in front and runs out at the sides
                r = 1 - .42 * max(0.0, math.cos(a))**.5
            c, s = math.cos(latitude) * r, math.sin(latitude)
            if not outside:
                s = s * (1 + (r - 1) * .6)
            x, y, z = c * math.cos(a), s, c * math.sin(a)
            x, y = x * math.cos(lean) + y * math.sin(lean), -x * math.sin(lean) + y * math.cos(lean)
            tip = 1 + .32 * max(0.0, y)**2
            pinch = 1 - .22 * max(0.0, y)**1.5
            row.append((.155 * x * pinch, .985 + .17 * y * tip, -.155 * z * pinch))
        rows.append(row)
    return mesh(*tube(rows), 1.0)


def cross():
    """Returns the king's cross, whose foot is inside the crown."""
    w, arm, low, high, middle, thick = .026, .085, 1.52, 1.72, 1.64, .024
    outline = [(-w, low), (w, low), (w * .8, middle - .03), (arm, middle - .045),
               (arm, middle + .045), (w * .8, middle + .03), (w * 1.35, high), (-w * 1.35, high),
               (-w * .8, middle + .03), (-arm, middle + .045), (-arm, middle - .045),
               (-w * .8, middle - .03)]
    bevel = .008
    centre = (0, middle)

    def inner(p):
        return tuple(c + (q - c) *
                     (1 - bevel / max(.02, math.hypot(p[0] - centre[0], p[1] - centre[1])))
                     for q, c in zip(p, centre))

    rows = [[(*inner(p), -thick) for p in outline], [(*p, -thick + bevel) for p in outline],
            [(*p, thick - bevel) for p in outline], [(*inner(p), thick) for p in outline]]
    points, faces = tube(rows, caps=False)
    n = len(outline)
    last = 3 * n
    for side, order in ((0, -1), (last, 1)):  # the flat faces: five convex pieces
        for piece in ((0, 1, 2, 11), (2, 3, 4, 5), (5, 6, 7, 8), (8, 9, 10, 11), (2, 5, 8, 11)):
            faces.append(tuple(side + i for i in piece[::order]))
    return mesh(points, faces, .3)


def pieces(colour, name):
    """Returns the six shapes of a colour; both colours share the geometry."""
    first = colour == "White"
    look = f"USE {colour}"

    def one(kind, node):
        return shape(look, f"DEF {kind}_Form {node()}" if first else f"USE {kind}_Form")

    def turned(kind, profile):
        return one(kind, lambda: lathe(profile()[::-1], STEPS, .6, True, True))

    def group(kind, *nodes):
        return f"DEF {colour}_{kind} Group {{ children [\n  " + "\n  ".join(nodes) + " ] }"

    # first defined on a bishop
    ball = f"DEF {colour}_Bead " + shape(look,
                                         "DEF Bead Sphere { radius .036 }" if first else "USE Bead")
    beads = [
        at((.192 * math.cos(a), 1.352, .192 * math.sin(a)), f"USE {colour}_Bead")
        for a in (2 * math.pi * i / 9 for i in range(9))
    ]
    return {
        "pawn":
            group("Pawn", turned("Pawn", pawn)),
        "rook":
            group("Rook", turned("Rook", rook), one("Merlons", merlons)),
        "knight":
            group("Knight", turned("Plinth", plinth), one("Horse", knight_head)),
        "bishop":
            group("Bishop", turned("Bishop", bishop), one("Mitre", mitre), at((0, 1.215, 0), ball)),
        "queen":
            group("Queen", turned("Queen", queen), *beads,
                  at((0, 1.432, 0), shape(look, "Sphere { radius .055 }"))),
        "king":
            group("King", turned("King", king), one("Cross", cross)),
    }[name]


def plinth():
    return foot(.335) + curve([(.25, .165), (.235, .2),
                               (.225, .23)], 3) + arc(.205, .23, .02, .02, 0, 90, 3) + [(0, .25)]


def chess():
    parts, known = [], set()

    def piece(name, colour, kind, x, z, extra=0.0):
        key = f"{colour}_{kind.capitalize()}"
        child = f"USE {key}" if key in known else pieces(colour, kind)
        known.add(key)
        turn = {"White": 0.0, "Black": math.pi}[colour] + extra
        parts.append(f"DEF {name} " +
                     at((x, 0, z), child, turn=(0, 1, 0, turn) if abs(turn) > 1e-6 else None))

    names = []
    for rank, colour in ((1, "White"), (2, "White"), (7, "Black"), (8, "Black")):
        for file in range(8):
            names.append(f"Piece_{'abcdefgh'[file]}{rank}")
            piece(names[-1], colour, ORDER[file] if rank in (1, 8) else "pawn", file - 3.5,
                  4.5 - rank)
    spares = []
    for colour, side in (("White", 1), ("Black", -1)):
        for i, kind in enumerate(("queen", "rook", "bishop", "knight")):
            spares.append(f"Spare_{colour[0].lower()}{'qrbn'[i]}")
            piece(spares[-1], colour, kind, -6.2, side * (3.5 - i * .9))

    tile = "DEF Light_Square " + shape("USE Light", "DEF Square " + mesh(*bevelled(.497, .008), 0))
    dark = "DEF Dark_Square " + shape("USE Dark", "USE Square")
    squares = {True: [], False: []}
    for file in range(8):
        for rank in range(8):
            light = (file + rank) % 2 == 1
            first = not squares[light]
            node = (tile if light else dark) if first else (
                "USE Light_Square" if light else "USE Dark_Square")
            squares[light].append(at((file - 3.5, 0, 3.5 - rank), node))

    def used(list_of_names):
        return " ".join("USE " + n for n in list_of_names)

    script = (
        "DEF Chess Script {\n  url \"chess.tcl\"\n  directOutput TRUE\n"
        f"  field MFNode pieces [ {used(names)} ]\n  field MFNode spares [ {used(spares)} ]\n"
        "  field MFNode materials [ USE White_Material USE Black_Material USE Light_Squares_Material USE Dark_Squares_Material ]\n"
        "  field MFNode shaders [ USE White_Shader USE Black_Shader USE Board_Shader USE Dark_Squares_Shader USE Lamp_Shader ]\n"
        "  field MFString game [ ]\n  eventIn SFString play\n  eventIn SFTime next\n  eventIn SFTime tick\n  eventOut SFString position\n  eventOut SFString status\n}\n"
        "DEF Clock TimeSensor { loop TRUE }\nROUTE Clock.time TO Chess.tick")
    return HEADER + "\n".join([
        "# A full set of chess: White to move. The pieces are moved by chess.tcl, with a panel of buttons where the world is trusted;",
        "# without the engine for Tcl they stand as here. Written by tools/make_scenes.py.",
        'WorldInfo { title "Chess" info [ "part of OpenRT\'s examples" ] }',
        'NavigationInfo { type "EXAMINE" headlight FALSE }',
        viewpoint((2.6, 4.8, 9.9),
                  (.15, -.05, .1), .6, "DEF White_Player Viewpoint", 'description "White" '),
        viewpoint((-2.6, 4.8, -9.9),
                  (-.15, -.05, -.1), .6, "DEF Black_Player Viewpoint", 'description "Black" '),
        viewpoint((0, 13.4, .02),
                  (0, 0, 0), .72, "DEF Above Viewpoint", 'description "From above" '),
        viewpoint((-2.6, 1.15, 5.9),
                  (-2.1, .72, 2.0), .6, "DEF Close Viewpoint", 'description "Among the pieces" '),
        'ORTBackground { shader ORTShader { name "EnvironmentMap" file "environmentmap" '
        'options [ "texture texture studio.png", "1f intensity .8", "1f rotation 2.4" ] } }',
        "# The look of the pieces and squares: a Material holds the colours, and a shader uses them.",
        "Switch { choice [",
        look(
            "White",
            "White_Material Material { diffuseColor .93 .87 .72 specularColor .2 .2 .2 shininess .8 }",
            "White_Shader", '"1f index 1.5" "1f roughness .06"'),
        look(
            "Black",
            "Black_Material Material { diffuseColor .17 .09 .07 specularColor .3 .3 .3 shininess .8 }",
            "Black_Shader", '"1f index 1.55" "1f roughness .06"'),
        look(
            "Light",
            "Light_Squares_Material Material { diffuseColor .87 .78 .62 specularColor .1 .1 .1 shininess .6 }",
            "Board_Shader", '"1f index 1.5" "1f roughness .1"'),
        look(
            "Dark",
            "Dark_Squares_Material Material { diffuseColor .45 .24 .15 specularColor .1 .1 .1 shininess .6 }",
            "Dark_Squares_Shader",
            '"1f index 1.5" "1f roughness .1"'), "] }", "DEF Lamps Group { children [",
        at((-6, 9, 4.5),
           "DEF Lamp " + shape(
               'ORTAppearance { shader DEF Lamp_Shader ORTShader { name "Diffuse" file "diffuse" options [ '
               '"color reflectance 0 0 0" "color emission 13 12 10.2" ] } }',
               mesh([(-3, -2.3, 0), (3, -2.3, 0), (3, 2.3, 0), (-3, 2.3, 0)], [(0, 1, 2, 3)])),
           turn=aim((-6, 9, 4.5), (0, 0, 0))),
        at((7, 6, -6),
           shape(
               'ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options [ '
               '"color reflectance 0 0 0" "color emission 4 4.6 5.8" ] } }',
               mesh([(-2.5, -2.5, 0), (2.5, -2.5, 0), (2.5, 2.5, 0),
                     (-2.5, 2.5, 0)], [(0, 1, 2, 3)])),
           turn=aim((7, 6, -6), (0, 0, 0))), "] }", "DEF Board Group { children [", *squares[True],
        *squares[False], *frame(), "] }",
        "# Ledges of felt for pieces beside the board: y = 0, |x| from 4.8 to 7, |z| up to 4.5.",
        *ledges(),
        table(), "# White's pieces from a1 on, Black's, and those to which pawns may be promoted.",
        *parts, script
    ]) + "\n"


def look(name, material, shader, options):
    use = f'DEF {shader} ORTShader {{ name "Plastic" file "plastic" options [ {options} ] }}'
    return f"  Shape {{ appearance DEF {name} ORTAppearance {{\n    material DEF {material}\n    shader {use} }} }}"


def bevelled(half, bevel):
    top = [(-half + bevel, 0, half - bevel), (half - bevel, 0, half - bevel),
           (half - bevel, 0, -half + bevel), (-half + bevel, 0, -half + bevel)]
    low = [(x + math.copysign(bevel, x), -bevel, z + math.copysign(bevel, z)) for x, _, z in top]
    sides = [(i + 4, (i + 1) % 4 + 4, (i + 1) % 4, i) for i in range(4)]
    return top + low, [(0, 1, 2, 3)] + sides


def frame():
    """Returns four mitred bars with a rounded edge, and the wood below the squares."""
    inner, outer = 4.0, 4.62
    section = [(inner, -.3),
               (outer, -.3)] + arc(outer - .06, -.04, .06, .06, 0, 90, 4) + [(inner + .05, .02),
                                                                             (inner + .03, 0),
                                                                             (inner, -.01)]
    rows = [
        [(r * sx, y, r * sz) for sx, sz in ((1, 1), (1, -1), (-1, -1), (-1, 1))] for r, y in section
    ]
    n = len(rows)
    bars = []
    for side in range(4):
        points, faces = [], []
        for k in range(n):
            points += [rows[k][side], rows[k][(side + 1) % 4]]
        for k in range(n - 1):
            faces.append((2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2))
        axis = "0 0 1" if side % 2 == 0 else "1 0 0"
        pith = {0: "2.6 -1.9 0", 1: "0 -2.2 -3.1", 2: "-2.4 -2 0", 3: "0 -1.8 2.7"}[side]
        wood = (
            f'ORTAppearance {{ shader ORTShader {{ name "Wood" file "wood" options [ "3f axis {axis}" "3f pith {pith}" "1f rings 5" '
            '"color light .2 .085 .04" "color dark .075 .028 .014" "1f varnish 1.5" "1f grain .4" ] } }'
        )
        bars.append(shape(wood, mesh(points, faces, .9)))
    under = shape(
        'ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options "color reflectance .03 .02 .015" } }',
        mesh([(-4.02, -.02, 4.02), (4.02, -.02, 4.02), (4.02, -.02, -4.02), (-4.02, -.02, -4.02)],
             [(0, 1, 2, 3)]))
    letters = []
    for i in range(8):
        letters.append(label("abcdefgh"[i], (i - 3.5, .0215, 4.3)))
        letters.append(label(str(i + 1), (-4.33, .0215, 3.5 - i)))
    return [under, *bars, *letters]


def label(text, place):
    global_style = 'DEF Lettering FontStyle { size .26 justify [ "MIDDLE" "MIDDLE" ] style "BOLD" }' if text == "a" else "USE Lettering"
    gold = (
        'DEF Gold ORTAppearance { shader ORTShader { name "Metal" file "metal" options [ "color n .16 .42 1.35" "color k 3.5 2.4 1.8" '
        '"1f roughness .25" ] } }') if text == "a" else "USE Gold"
    return at(place,
              shape(gold, f'Text {{ string "{text}" fontStyle {global_style} }}'),
              turn=(1, 0, 0, -1.5708))


def ledges():
    felt = shape(
        'DEF Felt ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options "color reflectance .035 .11 .06" } }',
        mesh([(-1.08, 0, 4.5), (1.08, 0, 4.5), (1.08, 0, -4.5), (-1.08, 0, -4.5)], [(0, 1, 2, 3)]))
    wood = (
        'ORTAppearance { shader ORTShader { name "Wood" file "wood" options [ "3f axis 0 0 1" "3f pith 2 -2 0" "1f rings 5" '
        '"color light .2 .085 .04" "color dark .075 .028 .014" "1f varnish 1.5" "1f grain .4" ] } }'
    )
    bar = 'DEF Ledge Group { children [\n  ' + at(
        (0, -.152, 0), shape(wood, box(2.34, .298, 9.24))) + "\n  " + felt + " ] }"
    return [at((5.85, 0, 0), bar), at((-5.85, 0, 0), "USE Ledge")]


def table():
    wood = (
        'ORTAppearance { shader ORTShader { name "Wood" file "wood" options [ "3f axis 1 0 .06" "3f pith 0 -5 3" "1f rings 1.6" '
        '"color light .36 .2 .1" "color dark .2 .1 .045" "1f varnish 1.5" "1f wobble .8" ] } }')
    return at((0, -.5, 0), "DEF Table " + shape(wood, box(26, .398, 20)))
