"""Building blocks for the worlds of make_scenes.py and of this folder: numbers and nodes as text,
surfaces of revolution, views. They use plain arithmetic on Python floats, rounded when written, so
the text is the same on every machine."""
import math

HEADER = "#VRML V2.0 utf8\n"


def number(x):
    # rounding leaves such values instead of 0, and they differ: sum() of floats changed in Python
    # 3.12
    if abs(x) < 1e-12:
        return "0"
    text = f"{x:.5g}"
    return "0" if text == "-0" else text


def numbers(values):
    return " ".join(number(v) for v in values)


def shader(name, file, *options):
    """Returns an ORTAppearance; the caller's text shares it if it has a DEF name."""
    listed = " ".join(f'"{o}"' for o in options)
    return f'ORTAppearance {{ shader ORTShader {{ name "{name}" file "{file}" options [ {listed} ] }} }}'


def shape(appearance, geometry):
    return f"Shape {{ appearance {appearance} geometry {geometry} }}"


def at(place, *children, turn=None):
    rotation = f" rotation {numbers(turn)}" if turn else ""
    return f"Transform {{ translation {numbers(place)}{rotation} children [\n  " + "\n  ".join(
        children) + " ] }"


def box(*size):
    return f"Box {{ size {numbers(size)} }}"


def quad(a, b, c, d, solid=False):
    """Returns a quadrilateral that faces the side from which a b c d run counter-clockwise."""
    points = ", ".join(numbers(p) for p in (a, b, c, d))
    return (
        f"IndexedFaceSet {{ solid {'TRUE' if solid else 'FALSE'} coord Coordinate {{ point [ {points} ] }} "
        "coordIndex [ 0 1 2 3 ] }")


def lathe(profile, steps=48, crease=0.6, solid=False, up=False):
    """Returns the surface that a curve of points (distance from the axis, position along it) sweeps
    about +z, or +y: an Extrusion along a circle. With the axis on the left and the curve followed
    from its first point to its last, the outside is on its left."""
    circle = [(math.cos(2 * math.pi * i / steps), math.sin(2 * math.pi * i / steps), 0)
              for i in range(steps)]
    if up:
        circle = [(x, 0, -y) for x, y, _ in circle]
    spine = ", ".join(numbers(p) for p in circle + circle[:1])
    section = ", ".join(numbers((r - 1, z)) for r, z in profile)
    return (
        f"Extrusion {{ beginCap FALSE endCap FALSE solid {'TRUE' if solid else 'FALSE'} creaseAngle {crease}\n"
        f"    spine [ {spine} ]\n    crossSection [ {section} ] }}")


def mesh(points, faces, crease=0.0, solid=True, extra=""):
    """Returns an IndexedFaceSet: faces are lists of indices into `points`, counter-clockwise seen
    from outside."""
    listed = ", ".join(numbers(p) for p in points)
    indices = " ".join(" ".join(str(i) for i in face) + " -1" for face in faces)
    return (
        f"IndexedFaceSet {{ solid {'TRUE' if solid else 'FALSE'} creaseAngle {number(crease)} {extra}\n"
        f"    coord Coordinate {{ point [ {listed} ] }}\n    coordIndex [ {indices} ] }}")


def tube(rows, closed_rings=True, caps=True):
    """Returns points and faces of a tube of rings with equally many points; fans close its ends.
    Each ring runs counter-clockwise seen from the last one."""
    n = len(rows[0])
    points = [p for row in rows for p in row]
    faces = []
    for k in range(len(rows) - 1):
        for i in range(n if closed_rings else n - 1):
            j = (i + 1) % n
            faces.append((k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i))
    if caps:
        for k, turn in ((0, -1), (len(rows) - 1, 1)):
            middle = len(points)
            points.append(tuple(sum(p[a] for p in rows[k]) / n for a in range(3)))
            for i in range(n):
                j = (i + 1) % n
                faces.append((middle, k * n + i, k * n + j) if turn > 0 else (middle, k * n + j,
                                                                              k * n + i))
    return points, faces


def curve(points, steps=6):
    """Returns a smooth curve through points of any dimension: uniform Catmull-Rom with
    repeated end points, which suffices for profiles."""
    line = []
    for i in range(len(points) - 1):
        a, b, c, d = points[max(i - 1,
                                0)], points[i], points[i + 1], points[min(i + 2,
                                                                          len(points) - 1)]
        for s in range(steps):
            t = s / steps
            line.append(
                tuple(q + t / 2 * (r - p + t * (2 * p - 5 * q + 4 * r - s3 + t *
                                                (3 * (q - r) + s3 - p)))
                      for p, q, r, s3 in zip(a, b, c, d)))
    return line + [tuple(points[-1])]


def arc(x, y, rx, ry, start, end, steps=8):
    """Returns points of an ellipse about (x, y); angles in degrees."""
    return [(x + rx * math.cos(math.radians(start + (end - start) * i / steps)),
             y + ry * math.sin(math.radians(start + (end - start) * i / steps)))
            for i in range(steps + 1)]


def world(title, view, *parts):
    return (
        HEADER +
        f'WorldInfo {{ title "{title}" }}\nNavigationInfo {{ type "EXAMINE" headlight FALSE }}\n{view}\n'
        + "\n".join(parts) + "\n")


def viewpoint(position, target, angle, kind="Viewpoint", extra=""):
    """Returns a Viewpoint that looks at a target, with +y up; its rotation combines two."""
    x, y, z = (t - p for t, p in zip(target, position))
    yaw, pitch = math.atan2(-x, -z), math.atan2(y, math.hypot(x, z))
    # quaternion of the rotation about y after the rotation about x
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    w, q = cy * cp, (cy * sp, sy * cp, -sy * sp)
    length = math.hypot(*q)
    axis = [c / length for c in q] if length > 0 else [0, 0, 1]
    turn = 2 * math.atan2(length, w)
    return f"{kind} {{ position {numbers(position)} orientation {numbers(axis + [turn])} fieldOfView {number(angle)} {extra}}}"


def aim(place, target):
    """Rotates +z, the direction in which lamps shine, towards a target."""
    x, y, z = (b - a for a, b in zip(place, target))
    length = math.sqrt(x * x + y * y + z * z)
    axis, flat = (-y, x, 0), math.hypot(x, y)
    if flat < 1e-9:
        return (0, 1, 0, 0 if z > 0 else math.pi)
    return (*(a / flat for a in axis), math.acos(z / length))
