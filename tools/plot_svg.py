"""Writes plots as SVG without any library: lines of (x, y) on logarithmic axes."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 460, 320
LEFT, RIGHT, TOP, BOTTOM = 62, 12, 34, 46
COLOURS = ("#c0392b", "#2471a3", "#1e8449", "#b7950b", "#7d3c98", "#5d6d7e")


def decades(values):
    low, high = math.floor(math.log10(min(values)) +
                           1e-9), math.ceil(math.log10(max(values)) - 1e-9)
    return low, max(high, low + 1)


def tick(power):
    return f"{10.0 ** power:g}"


def log_plot(title, xlabel, ylabel, lines):
    """Returns the text of an SVG file. lines: name -> list of (x, y) or (x, y, lower end, upper end
    of a bar), all above 0."""
    points = [p for line in lines.values() for p in line]
    x0, x1 = decades([p[0] for p in points])
    y0, y1 = decades([y for p in points for y in p[1:]])
    across, up = (WIDTH - LEFT - RIGHT) / (x1 - x0), (HEIGHT - TOP - BOTTOM) / (y1 - y0)

    def place(x, y):
        return LEFT + (math.log10(x) - x0) * across, HEIGHT - BOTTOM - (math.log10(y) - y0) * up

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="sans-serif" font-size="11">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{LEFT}" y="20" font-size="13" font-weight="bold">{escape(title)}</text>'
    ]
    for power in range(x0, x1 + 1):
        x = LEFT + (power - x0) * across
        out.append(
            f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
            f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{tick(power)}</text>'
        )
    for power in range(y0, y1 + 1):
        y = HEIGHT - BOTTOM - (power - y0) * up
        out.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{tick(power)}</text>')
    out.append(
        f'<text x="{(LEFT + WIDTH - RIGHT) / 2:.0f}" y="{HEIGHT - 12}" text-anchor="middle">{escape(xlabel)}</text>'
    )
    out.append(
        f'<text transform="translate(14 {(TOP + HEIGHT - BOTTOM) / 2:.0f}) rotate(-90)" text-anchor="middle">{escape(ylabel)}</text>'
    )
    for n, (name, line) in enumerate(lines.items()):
        colour = COLOURS[n % len(COLOURS)]
        path = " ".join(
            f"{'ML'[i > 0]}{x:.1f} {y:.1f}" for i, (x, y) in enumerate(place(*p[:2]) for p in line))
        out.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in (place(*p[:2])
                                                                                      for p in line)
        ]
        for x, _, low, high in (p for p in line if len(p) > 2):
            (left, bottom), (_, top) = place(x, low), place(x, high)
            out.append(f'<path d="M{left:.1f} {bottom:.1f}V{top:.1f}" stroke="{colour}"/>')
        y = TOP + 14 + 15 * n
        out.append(
            f'<path d="M{WIDTH - RIGHT - 118} {y - 4}h18" stroke="{colour}" stroke-width="2"/>'
            f'<text x="{WIDTH - RIGHT - 94}" y="{y}">{escape(name)}</text>')
    return "\n".join(out) + "\n</svg>\n"
