"""Draws `frames.svg`: a tool on a surface with the frames, the outline and the signs of margins.

`python -m conformance.docs.frames` writes it anew.
"""

import math
from pathlib import Path

_INK, _TOOL, _HOLDER, _PART, _BAD, _GOOD = "#222222", "#56B4E9", "#999999", "#D9C8A9", "#D55E00", "#007A5A"
_TILT = math.radians(28.0)
_SCALE = 9.0

Point = tuple[float, float]


def _line(a: Point, b: Point, colour: str = _INK, more: str = "") -> str:
    return f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{colour}" stroke-width="1.6" {more}/>'


def _arrow(a: Point, b: Point, colour: str = _INK) -> str:
    return _line(a, b, colour, 'marker-end="url(#head)"')


def _both(a: Point, b: Point, colour: str = _INK) -> str:
    return _line(a, b, colour, 'marker-end="url(#head)" marker-start="url(#head)"')


def _text(at: Point, words: str, colour: str = _INK, anchor: str = "start", size: int = 15, weight: str = "normal") -> str:
    return (
        f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="{colour}" text-anchor="{anchor}" font-size="{size}" font-weight="{weight}" '
        f'stroke="white" stroke-width="4" paint-order="stroke">{words}</text>'
    )


def _shape(points: list[Point], fill: str, more: str = "") -> str:
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polygon points="{corners}" fill="{fill}" stroke="{_INK}" stroke-width="1.2" {more}/>'


def _dot(at: Point, colour: str = _INK) -> str:
    return f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="4" fill="{colour}"/>'


def _posture() -> list[str]:
    """Return the first drawing: a bull nose that leans over a plane beside a wall."""
    contact = (200.0, 400.0)
    flat, corner, radius, flutes, top, shank = 4.0, 2.0, 6.0, 14.0, 24.0, 4.5
    axis, out = (math.sin(_TILT), math.cos(_TILT)), (math.cos(_TILT), -math.sin(_TILT))
    # The corner's centre lies above the contact along the normal; the tip follows from it (mm, y upwards).
    tip = (-flat * out[0] - corner * axis[0], corner - flat * out[1] - corner * axis[1])

    def at(height: float, r: float) -> Point:
        return (contact[0] + _SCALE * (tip[0] + height * axis[0] + r * out[0]), contact[1] - _SCALE * (tip[1] + height * axis[1] + r * out[1]))

    corner_line = [(corner - corner * math.cos(t), flat + corner * math.sin(t)) for t in (math.pi / 2 * k / 16 for k in range(17))]

    def body(line: list[Point], fill: str) -> str:
        return _shape([at(h, r) for h, r in line] + [at(h, -r) for h, r in reversed(line)], fill, 'fill-opacity="0.65"')

    out_lines = [
        _shape([(20, 400), (420, 400), (420, 300), (500, 300), (500, 470), (20, 470)], _PART),
        body([(top, 9.0), (34.0, 9.0)], _HOLDER),
        body([(flutes, shank), (top, shank)], "#BFE0F2"),
        body([(0.0, flat), *corner_line, (flutes, radius)], _TOOL),
        _line(at(-3, 0), at(37, 0), _INK, 'stroke-dasharray="9 4 2 4"'),
        _arrow(at(34, 0), at(42, 0)),
        _text((at(42, 0)[0] - 10, at(42, 0)[1] - 2), "axis", anchor="end", weight="bold"),
        _arrow(contact, (contact[0], contact[1] - 190)),
        _text((contact[0] - 8, contact[1] - 180), "normal", anchor="end", weight="bold"),
        _text((contact[0] - 8, contact[1] - 163), "out of the material", anchor="end", size=12),
        _dot(contact, _BAD),
        _text((contact[0] + 4, contact[1] + 24), "contact", _BAD, weight="bold"),
        _dot(at(0, 0)),
        _text((at(0, 0)[0] - 12, at(0, 0)[1] + 4), "tip", anchor="end", weight="bold"),
    ]
    # The angle from the normal to the axis, about the contact.
    reach = 120.0
    end = (contact[0] + reach * math.sin(_TILT), contact[1] - reach * math.cos(_TILT))
    out_lines += [
        _line(contact, (contact[0] + 1.15 * reach * axis[0], contact[1] - 1.15 * reach * axis[1]), _INK, 'stroke-dasharray="3 3"'),
        f'<path d="M {contact[0]} {contact[1] - reach} A {reach} {reach} 0 0 1 {end[0]:.1f} {end[1]:.1f}" fill="none" stroke="{_INK}" stroke-width="1.6"/>',
        _text((contact[0] + 14, contact[1] - reach - 8), "tilt", weight="bold"),
        _text((30, 455), "material"),
        _text((at(29, 0)[0] - 24, at(29, 0)[1] + 5), "holder"),
        _text((at(19, 0)[0] - 22, at(19, 0)[1] + 5), "shank"),
        _text((at(9, 0)[0] - 14, at(9, 0)[1] + 20), "cutter"),
        _text((20, 30), "A posture: contact, normal, axis, tip", size=18, weight="bold"),
        _text((20, 52), "mm, unit vectors, part coordinates", size=13),
    ]
    return out_lines


def _outline() -> list[str]:
    """Return the second drawing: the outline of the tool, radius over height."""
    base, scale = (590.0, 400.0), 9.0

    def spot(h: float, r: float) -> Point:
        return (base[0] + scale * r, base[1] - scale * h)

    arc = [(2.0 - 2.0 * math.cos(t), 4.0 + 2.0 * math.sin(t)) for t in (math.pi / 2 * k / 16 for k in range(17))]
    cutter = [spot(h, r) for h, r in [(0.0, 0.0), (0.0, 4.0), *arc, (14.0, 6.0), (14.0, 4.5), (24.0, 4.5)]]
    holder = [spot(h, r) for h, r in [(24.0, 0.0), (24.0, 9.0), (34.0, 9.0), (34.0, 0.0)]]
    return [
        _shape([*cutter, spot(24.0, 0.0)], _TOOL, 'fill-opacity="0.65"'),
        _shape(holder, _HOLDER, 'fill-opacity="0.65"'),
        _arrow(spot(0, 0), spot(37, 0)),
        _text((base[0] - 8, spot(35.4, 0)[1]), "height", anchor="end", weight="bold"),
        _arrow(spot(0, 0), spot(0, 13)),
        _text((spot(0, 13)[0] - 4, base[1] + 22), "radius", weight="bold", anchor="end"),
        *(_dot(spot(h, r)) for h, r in [(0, 4), (2, 6), (14, 6), (14, 4.5), (24, 4.5), (24, 9), (34, 9)]),
        _text((spot(0, 4)[0] - 4, base[1] + 22), "(0, 4)", size=13, anchor="middle"),
        _text((spot(2, 6)[0] + 8, spot(2, 6)[1] + 2), "(2, 6, 2): corner arc 2", size=13),
        _text((spot(14, 6)[0] + 8, spot(14, 6)[1] + 5), "(14, 6), then (14, 4.5)", size=13),
        _text((spot(24, 9)[0] + 8, spot(24, 9)[1] + 5), "holder (24, 9)", size=13),
        _text((spot(34, 9)[0] + 8, spot(34, 9)[1] + 5), "(34, 9)", size=13),
        _line((base[0] - 34, spot(14, 0)[1]), spot(14, 0), _INK, 'stroke-dasharray="3 3"'),
        _text((base[0] - 36, spot(14, 0)[1] + 5), "cutting", anchor="end", size=13),
        _text((base[0] - 8, base[1] + 5), "tip", anchor="end", weight="bold"),
        _text((540, 30), "A tool: radius over height", size=18, weight="bold"),
        _text((540, 52), "cutter and holder, both from the tip", size=13),
    ]


def _margins() -> list[str]:
    """Return the third drawing: the signs."""
    left, right = 890.0, 1095.0

    def tool(x: float) -> str:
        return _shape([(x - 45, 130), (x + 45, 130), (x + 45, 330), (x - 45, 330)], _TOOL, 'fill-opacity="0.65"')

    return [
        tool(left),
        _shape([(left + 85, 180), (left + 125, 180), (left + 125, 330), (left + 85, 330)], _PART),
        _both((left + 46, 250), (left + 84, 250), _GOOD),
        _text((left + 10, 355), "margin &gt; 0", _GOOD, weight="bold"),
        _text((left - 45, 375), "clearance of what is not", size=13),
        _text((left - 45, 392), "in contact", size=13),
        tool(right),
        _shape([(right + 5, 180), (right + 105, 180), (right + 105, 330), (right + 5, 330)], _PART, 'fill-opacity="0.8"'),
        f'<circle cx="{right + 5}" cy="250" r="40" fill="none" stroke="{_BAD}" stroke-width="2"/>',
        _dot((right + 5, 250), _BAD),
        _line((right + 5, 250), (right + 45, 250), _BAD),
        _text((right - 25, 355), "margin &lt; 0", _BAD, weight="bold"),
        _text((right - 45, 375), "minus the depth: radius of the", size=13),
        _text((right - 45, 392), "largest ball about a point of the", size=13),
        _text((right - 45, 409), "material that fits in a piece of it", size=13),
        _text((845, 30), "Signs of a margin", size=18, weight="bold"),
        _text((845, 52), "low and high bound it; limit_deg &gt; 0: within the machine's limit", size=13),
        _text((845, 74), "blocked: margin &lt; 0 or limit_deg &lt; 0", size=13),
        _text((845, 94), "at the border: between -tolerance and +tolerance", size=13),
    ]


def figure() -> str:
    """Return the figure."""
    head = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1280 490" font-family="sans-serif" '
        'role="img" aria-labelledby="t d">\n'
        '<title id="t">Frames and signs of the benchmark</title>\n'
        '<desc id="d">A tool at its contact with normal, axis, tip and tilt; its outline as radius over height; '
        "positive and negative margin.</desc>\n"
        f'<defs><marker id="head" markerWidth="10" markerHeight="8" refX="9" refY="4" orient="auto-start-reverse">'
        f'<path d="M0,0 L10,4 L0,8 z" fill="{_INK}"/>'
        '</marker></defs>\n<rect width="1280" height="490" fill="white"/>\n'
    )
    return head + "\n".join([*_posture(), *_outline(), *_margins()]) + "\n</svg>\n"


if __name__ == "__main__":
    (Path(__file__).parent / "frames.svg").write_text(figure(), encoding="utf-8")
