"""A tool with a flat bottom that stands upright on a contact: where may its axis be, so that the contact lies under the flat?

Places are pairs (u, v) in the plane across the axis, from the contact. What a convex piece of the tool meets at an obstacle
point it meets from all places nearer to that point than the piece's radius at the point's height. So a triangle that was met
forbids at least what is nearer to a part of it than a radius: a convex polygon, grown. Places are left only outside all of these
and within the flat's radius. If any are left there is one among few: on the rim of the flat, or where two borders cross
(`docs/at_a_sample.md`, lemma S6). Each place is tried with all of the tool, as a search tries a posture.

A tool whose straight flank lies along a surface touches with any point of it: the tool slides by its length, and the contact
stays. A point that is in a piece of the tool is in it over one interval of the slide, for a piece is convex; what is left is
probed, as a search probes tilts.
"""

from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import ARC, CYLINDER, HIGH, INSIDE, KIND, LOW, NO_REASON, OFFSET_OF, RADIUS, RISE, ROUND, SLOPE
from plan_cutters.kernels.jit import entry, kernel, maker
from plan_cutters.kernels.linear.tree import half_of
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import attribute_of, inside, mode_at, next_tilt
from plan_cutters.kernels.tool.apart import BODY, HALF, OFFSET, A, P, X, Y
from plan_cutters.kernels.tool.arcs import remove
from plan_cutters.kernels.tool.hit import everything, into_frame, scratch, stand, tree_hit, triangle_hit
from plan_cutters.kernels.tool.pieces import clipped, inset, shadow_area

#: What a place is: none, none that could be (proved), or one where the tool was put down.
NONE, FORBIDDEN, PLACED = 0, 1, 2
#: Grown polygons that are complete, their corners, lines and circles of all borders, and places.
_SHAPES, _CORNERS, _BORDERS, _PLACES = 64, 7, 1024, 1024
#: Places that are looked at first: on the rim of the flat, halfway, and in the middle.
_RIM, _RING = 36, 8
#: Borders of places are held apart from what is forbidden by this share of the flat's radius, at least so much, mm; and rounding,
#: mm.
_SHARE, _APART, _ROUNDING = 1e-6, 1e-7, 1e-9
#: Lengths from the axis to the contact are no smaller share of the flat's radius: they say where the contact lies.
LEAST_SHARE = 1e-6


#: A workspace: what is forbidden, corner (s, c, 2), corners (s,) and radius (s,) of grown polygons; border (b, 5), the lines (0,
#: from, to) and circles (1, centre, radius) around these; place (p, 2), how far each is from what is forbidden, margin (p,), and
#: whether it is open (p,). counts (3,): how many of each there are. A body for the tool.
Flat = namedtuple("Flat", "corner corners radius border place margin open_ counts body y scratch")


@maker
def flat_workspace():
    """Make a workspace."""
    return Flat(
        np.empty((_SHAPES, _CORNERS, 2)), np.zeros(_SHAPES, np.int64), np.empty(_SHAPES), np.empty((_BORDERS, 5)),
        np.empty((_PLACES, 2)), np.empty(_PLACES), np.zeros(_PLACES, np.bool_), np.zeros(3, np.int64), np.empty(BODY),
        np.empty(3), scratch(),
    )  # fmt: skip


@kernel
def _away(u, v, flat, s):
    """How far a place is from grown polygon s: negative in it."""
    many, least = flat.corners[s], np.inf
    within, sign = many > 2, 0.0
    for i in range(many):
        j = i + 1 if i + 1 < many else 0
        x, y = flat.corner[s, i, 0], flat.corner[s, i, 1]
        ex, ey = flat.corner[s, j, 0] - x, flat.corner[s, j, 1] - y
        dx, dy = u - x, v - y
        size = ex * ex + ey * ey
        part = min(1.0, max(0.0, (dx * ex + dy * ey) / size)) if size > 0.0 else 0.0
        dx, dy = dx - part * ex, dy - part * ey
        least = min(least, dx * dx + dy * dy)
        side = ex * (v - y) - ey * (u - x)
        if side * sign < 0.0 or side == 0.0:
            within = False
        sign = side
    return -flat.radius[s] if within else np.sqrt(least) - flat.radius[s]


@kernel
def _add_place(u, v, most, flat):
    """Enter a place that nothing known forbids; whether there was space for it."""
    if u * u + v * v > most * most * (1.0 + 1e-12) + _ROUNDING * _ROUNDING:
        return True
    margin = np.inf
    for s in range(flat.counts[0]):
        margin = min(margin, _away(u, v, flat, s))
        if margin < -_ROUNDING:
            return True
    at = flat.counts[2]
    if at == len(flat.place):
        return False
    flat.place[at, 0], flat.place[at, 1], flat.margin[at], flat.open_[at] = u, v, margin, True
    flat.counts[2] += 1
    return True


@kernel
def _on_line(border, other, most, flat):
    """Enter where a line crosses a line or a circle."""
    x, y = flat.border[border, 1], flat.border[border, 2]
    ex, ey = flat.border[border, 3] - x, flat.border[border, 4] - y
    a = ex * ex + ey * ey
    if a == 0.0:
        return True
    ox, oy = flat.border[other, 1], flat.border[other, 2]
    if flat.border[other, 0] == 0.0:
        gx, gy = flat.border[other, 3] - ox, flat.border[other, 4] - oy
        det = ex * gy - ey * gx
        if det == 0.0:
            return True
        s = ((ox - x) * gy - (oy - y) * gx) / det
        t = ((ox - x) * ey - (oy - y) * ex) / det
        if -1e-9 <= s <= 1.0 + 1e-9 and -1e-9 <= t <= 1.0 + 1e-9:
            return _add_place(x + s * ex, y + s * ey, most, flat)
        return True
    r = flat.border[other, 3]
    half, c = (x - ox) * ex + (y - oy) * ey, (x - ox) ** 2 + (y - oy) ** 2 - r * r
    square = half * half - a * c
    if square < 0.0:
        return True
    complete = True
    for sign in (-1.0, 1.0):
        s = (-half + sign * np.sqrt(square)) / a
        if -1e-9 <= s <= 1.0 + 1e-9:
            complete = _add_place(x + s * ex, y + s * ey, most, flat) and complete
    return complete


@kernel
def _cross_borders(border, other, most, flat):
    """Enter where two borders cross; whether there was space for it."""
    if flat.border[border, 0] == 0.0:
        return _on_line(border, other, most, flat)
    if flat.border[other, 0] == 0.0:
        return _on_line(other, border, most, flat)
    x, y, r = flat.border[border, 1], flat.border[border, 2], flat.border[border, 3]
    dx, dy, q = flat.border[other, 1] - x, flat.border[other, 2] - y, flat.border[other, 3]
    d = np.sqrt(dx * dx + dy * dy)
    if d == 0.0 or d > r + q or d < abs(r - q):
        return True
    along = (d * d + r * r - q * q) / (2.0 * d)
    across = np.sqrt(max(0.0, r * r - along * along))
    dx, dy = dx / d, dy / d
    complete = _add_place(x + along * dx - across * dy, y + along * dy + across * dx, most, flat)
    return _add_place(x + along * dx + across * dy, y + along * dy - across * dx, most, flat) and complete


@kernel
def _add_border(kind, a, b, c, d, flat):
    at = flat.counts[1]
    if at == len(flat.border):
        return False
    border = flat.border[at]
    border[0], border[1], border[2], border[3], border[4] = kind, a, b, c, d
    flat.counts[1] += 1
    return True


@kernel
def _forbid(flat, many, radius, apart, most):
    """Forbid what is nearer than a radius to the polygon written behind the others; whether there was space for all of it."""
    s, first = flat.counts[0], flat.counts[1]
    flat.corners[s], flat.radius[s] = many, radius + apart
    flat.counts[0] += 1
    for i in range(flat.counts[2]):
        if flat.open_[i]:
            flat.margin[i] = min(flat.margin[i], _away(flat.place[i, 0], flat.place[i, 1], flat, s))
            flat.open_[i] = flat.margin[i] >= -_ROUNDING
    r, complete = flat.radius[s], True
    for i in range(many):
        x, y = flat.corner[s, i, 0], flat.corner[s, i, 1]
        complete = _add_border(1.0, x, y, r, 0.0, flat) and complete
        j = i + 1 if i + 1 < many else 0
        if j == i or (many == 2 and i == 1):
            continue
        ex, ey = flat.corner[s, j, 0] - x, flat.corner[s, j, 1] - y
        size = np.sqrt(ex * ex + ey * ey)
        if size > 0.0:
            for side in (-r / size, r / size):
                wx, wy = -ey * side, ex * side
                complete = _add_border(0.0, x + wx, y + wy, x + ex + wx, y + ey + wy, flat) and complete
    for i in range(first, flat.counts[1]):
        for k in range(first):
            complete = _cross_borders(i, k, most, flat) and complete
    return complete


@kernel
def _slice(source, count, level, corner):
    """Write where the sides of a polygon of rows (height, x, y) pass a height, (2, 2) at most; how many points."""
    written = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        low, high = source[i, 0] - level, source[j, 0] - level
        if (low < 0.0) == (high < 0.0) or written == 2:
            continue
        part = low / (low - high)
        for k in range(2):
            corner[written, k] = source[i, 1 + k] + part * (source[j, 1 + k] - source[i, 1 + k])
        written += 1
    return written


@kernel
def _radius_at(piece, k, height):
    """The radius of piece k, a cone or an arc, at a height: a little less where that is rounded."""
    if piece[k, KIND] == ARC:
        away = height - piece[k, SLOPE]
        return piece[k, RADIUS] + np.sqrt(max(0.0, piece[k, ROUND] * piece[k, ROUND] - away * away)) - 1e-12
    return piece[k, RADIUS] + piece[k, SLOPE] * (height - piece[k, LOW]) - 1e-12


@kernel
def _met(vertex, triangle, piece, k, hit, u, v, flat):
    """Write what a triangle met in piece k at `hit` forbids, a polygon behind the others; its corners, and its growth."""
    corner = flat.scratch.corner
    _, least, most, _ = into_frame(vertex, triangle, flat.body, 0.0, corner)
    low, high = piece[k, LOW], piece[k, HIGH]
    shape = flat.corner[flat.counts[0]]
    if piece[k, KIND] == CYLINDER:
        where, count = clipped(corner, 3, least, most, low, high, flat.scratch.polygon, flat.scratch.spare)
        source = corner if where == 0 else flat.scratch.polygon if where == 1 else flat.scratch.spare
        if 0 < count <= _CORNERS:
            thin = shadow_area(source, count) == 0.0
            if not thin:
                for i in range(count):
                    shape[i, 0], shape[i, 1] = source[i, 1] + u, source[i, 2] + v
                return count, piece[k, RADIUS]
            # Seen along the axis it is a line: from one end of it to the other.
            far, first, last = -1.0, 0, 0
            for i in range(count):
                for j in range(i + 1):
                    size = (source[i, 1] - source[j, 1]) ** 2 + (source[i, 2] - source[j, 2]) ** 2
                    if size > far:
                        far, first, last = size, i, j
            shape[0, 0], shape[0, 1] = source[first, 1] + u, source[first, 2] + v
            shape[1, 0], shape[1, 1] = source[last, 1] + u, source[last, 2] + v
            return 2 if far > 0.0 else 1, piece[k, RADIUS]
    else:
        # A cut through it where the piece is widest, if that meets it too, or else through the point that was met.
        best = piece[k, SLOPE] if piece[k, KIND] == ARC else high if piece[k, SLOPE] > 0.0 else low
        for level in (min(min(high, most), max(max(low, least), best)), hit[0]):
            if low <= level <= high and _slice(corner, 3, level, shape) == 2:
                radius = _radius_at(piece, k, level)
                for i in range(2):
                    shape[i, 0] += u
                    shape[i, 1] += v
                flat.corners[flat.counts[0]], flat.radius[flat.counts[0]] = 2, radius
                if _away(u, v, flat, flat.counts[0]) < 0.0:
                    return 2, radius
    shape[0, 0], shape[0, 1] = hit[1] + u, hit[2] + v
    return 1, piece[k, RADIUS] if piece[k, KIND] == CYLINDER else _radius_at(piece, k, hit[0])


@kernel
def _best(flat):
    """The open place farthest from what is forbidden, -1 for none; the first of those that are as far."""
    best = -1
    for i in range(flat.counts[2]):
        if flat.open_[i] and (best < 0 or flat.margin[i] > flat.margin[best]):
            best = i
    return best


@kernel
def find_place(p, axis, x, tool, mode, rise, most, solids, within, apart, flat, place):
    """Look for a place at which a tool stands free, its bottom across the axis and a contact under the flat of its tip.

    `p`, `axis` (3,) float64: the contact, and the unit tool axis.
    `x` (3,) float64: unit direction of u, across the axis; v is that of axis x u.
    `mode` (int): in which it touches at tilt 0.
    `rise` (float): of the centre of the mode over the contact, along the axis, mm.
    `most` (float): radius of the flat, mm.
    `within` (float): winding number from which a place lies within a body.
    `apart` (float): places are held apart from what is forbidden by this, mm; what is left between is not found.
    `place` (2,) float64, written: u and v of the axis, mm.
    Returns `result` (int): PLACED; FORBIDDEN if what was met forbids all places, with `apart` more; or NONE. `triangle` (int):
      the one that was in the way last, -1 for none.
    """
    counts, body, y = flat.counts, flat.body, flat.y
    counts[:] = 0
    cross(axis, x, y)
    apart = max(apart, _APART, _SHARE * most)
    proved, last = _add_border(1.0, 0.0, 0.0, most, 0.0, flat), -1
    for i in range(_RIM):
        turn = 2.0 * np.pi * i / _RIM
        _add_place(-most * np.cos(turn), -most * np.sin(turn), most, flat)
    for i in range(_RING):
        turn = 2.0 * np.pi * i / _RING
        _add_place(-0.5 * most * np.cos(turn), -0.5 * most * np.sin(turn), most, flat)
    _add_place(0.0, 0.0, most, flat)
    while True:
        best = _best(flat)
        if best < 0:
            return FORBIDDEN if proved else NONE, last
        u, v = flat.place[best, 0], flat.place[best, 1]
        for k in range(3):
            body[P + k] = p[k] + rise * axis[k] + u * x[k] + v * y[k]
            body[A + k], body[X + k], body[Y + k] = axis[k], x[k], y[k]
        body[OFFSET], body[HALF] = 0.0, 0.0
        # Of what is in the way that which lies deep in the tool: it forbids most of the places about.
        triangle, which, height, px, py = tree_hit(solids.tree, body, tool.piece[mode], 0.0, -1, flat.scratch, True)
        if triangle < 0:
            if not inside(body, tool, mode, solids, within, flat.scratch):
                place[0], place[1] = u, v
                return PLACED, last
            return NONE, last
        last = triangle
        if counts[0] == len(flat.corner):
            return NONE, last
        vertex, triangle = half_of(solids.tree, triangle)
        many, radius = _met(vertex, triangle, tool.piece[mode], which, (height, px, py), u, v, flat)
        proved = _forbid(flat, many, radius, apart, most) and proved
        if flat.open_[best]:
            # By rounding: it was tried, and is not tried again.
            flat.open_[best], proved = False, False


@kernel
def across(direction, axis, out):
    """Write the unit direction across an axis that is nearest to a direction."""
    along = dot(axis, direction)
    for k in range(3):
        out[k] = direction[k] - along * axis[k]
    length = np.sqrt(dot(out, out))
    for k in range(3):
        out[k] /= length


@kernel
def place_to_direction(place, x, y, most, tilt_direction):
    """Write the way from the axis at a place to the contact: 1 long at the rim of the flat, and never nothing."""
    least = LEAST_SHARE * most
    if abs(place[0]) < least and abs(place[1]) < least:
        place[0] = -least
    for k in range(3):
        tilt_direction[k] = -(place[0] * x[k] + place[1] * y[k]) / most


@entry
def upright(rows, contacts, axis, tool, solids, within, apart, result, tilt_direction):
    """Look at contacts, each for itself, for a place of a tool with an axis, the contact under the flat of its tip.

    Or over its upper face, if it has one that cuts: where the axis goes into the material.

    `rows` (m,) int64.
    `axis` (n, 3) float64: unit tool axis, along the normal or against it, or nearly so.
    `within`, `apart` (float): as for `find_place`.
    `result` (n,) int8, written: PLACED, FORBIDDEN or NONE; FORBIDDEN too where the tool has no such flat.
    `tilt_direction` (n, 3) float64, written: where it is PLACED: the way from the axis to the contact, 1 at the rim of the flat.
    """
    flat, place, x = flat_workspace(), np.empty(2), np.empty(3)
    for row in rows:
        result[row] = FORBIDDEN
        along = dot(axis[row], contacts.normal[row])
        mode = mode_at(tool, 0.0 if along > 0.0 else np.pi)
        if mode < 0 or tool.mode[mode, OFFSET_OF] <= 0.0:
            continue
        most, rise = tool.mode[mode, OFFSET_OF], np.sign(along) * tool.mode[mode, RISE]
        across(contacts.direction_max[row], axis[row], x)
        result[row], _ = find_place(contacts.point[row], axis[row], x, tool, mode, rise, most, solids, within, apart, flat, place)
        if result[row] == PLACED:
            place_to_direction(place, x, flat.y, most, tilt_direction[row])


#: Places of a slide that are nearer together are one, mm: no machine holds them apart.
_NO_PLACE = 1e-3
#: Share of the slide that a place within a body stands for.
_IN_BODY = 0.02
#: Places that are tried at most: each takes a part of the slide away.
_PROBES = 200
#: What a place is: one where the tool stands free, none for a reason that was met, or not known.
FREE, NONE, UNKNOWN = 1, 0, 2
#: How often an end of what a point forbids is halved: to a millionth of the slide.
_HALVINGS = 20


@kernel
def _end(piece, k, point, step, length):
    """How far the tool may slide, up to `length`, and surely still hold a point of piece k, which goes `step` for each mm."""
    held, free, slide = 0.0, length, length
    for _ in range(_HALVINGS + 1):
        x = point[1] + slide * step[1]
        if inset(piece, k, point[0] + slide * step[0], x * x + point[2] * point[2]) > 0.0:
            held = slide
        else:
            free = slide
        slide = 0.5 * (held + free)
    return held


@kernel
def _slid(frame, turn, length, tool, mode, solids, within, hint, body, intervals, scratch):
    """Look for a place along a flank: (FREE, NONE or UNKNOWN, how far the tool has slid, why the first one is none, and the
    triangle that took away most of the slide, or -1). A triangle that is a hint is tried before all others.
    """
    cosine, sine = turn
    offset, rise, piece = tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE], tool.piece[mode]
    intervals[0, 0], intervals[0, 1] = 0.0, length
    count, wish, reason, sure = 1, 0.0, NO_REASON, True
    widest, most = -1.0, -1
    for _ in range(_PROBES):
        if count == 0:
            break
        slide = next_tilt(intervals, count, wish)
        stand(body, frame, cosine, sine, offset, rise)
        for k in range(3):
            body[P + k] -= slide * frame.f[k]
        triangle, which, height, x, y = hint, -1, 0.0, 0.0, 0.0
        if hint >= 0:
            vertex, row = half_of(solids.tree, hint)
            which, height, x, y = triangle_hit(vertex, row, body, piece, everything(piece), 0.0, scratch)
        if which < 0:
            hint = -1
            triangle, which, height, x, y = tree_hit(solids.tree, body, piece, 0.0, -1, scratch, True)
        if triangle < 0:
            if not inside(body, tool, mode, solids, within, scratch):
                return FREE, slide, NO_REASON, most
            # It touches no skin, and lies in a body: how far it may slide there is not looked for.
            reason, sure = INSIDE if reason == NO_REASON else reason, False
            count = remove(intervals, count, slide - _IN_BODY * length, slide + _IN_BODY * length, _NO_PLACE)
            if length <= 0.0:
                return NONE, 0.0, reason, most
            continue
        if reason == NO_REASON:
            reason = attribute_of(height * cosine + rise, x - offset, y, tool, mode, which)
        if length <= 0.0:
            return NONE, 0.0, reason, triangle
        # The tool slides against the tilt direction: in its frame a point goes with it.
        point = (height, x, y)
        first = slide - _end(piece, which, point, (-sine, -cosine), slide)
        last = slide + _end(piece, which, point, (sine, cosine), length - slide)
        count = remove(intervals, count, min(first, slide - 0.5 * _NO_PLACE), max(last, slide + 0.5 * _NO_PLACE), _NO_PLACE)
        if last - first > widest:
            widest, most = last - first, triangle
        wish = length if wish == 0.0 else -1.0
    return NONE if sure and count == 0 else UNKNOWN, 0.0, reason, most


@entry
def along_flank(rows, axis, contacts, flank, away, tool, solids, within, state, shift, reason, hint):
    """Lay the flank of a tool along surfaces, with its axis as it is given.

    `rows` (m,) int64: contacts.
    `axis` (m, 3) float64: unit tool axis at each, nowhere along the normal.
    `flank` (int, float): the mode in which the lower end of the flank touches, and by how much the tool may slide with the
      contact still on its flank, mm.
    `away` (k,) float64: distances from the contact, mm, that are tried one after the other, across the axis.
    `within` (float): winding number from which a place lies within a body.
    `state` (m,) int8, written: FREE at one of the distances; NONE: at each something is in the way, wherever along the flank; or
      UNKNOWN.
    `shift` (m, 3) float64, written: where it is free: from the contact to the point at which the lower end of the flank is put
      down, mm.
    `reason` (m,) uint8, written: where it is not: what is in the way of the first place; with a hint, of the first that was
      looked at.
    `hint` (m,) int64, read and written: a triangle that may well be in the way, or -1: where another axis was tried, that which
      took away most of the slide. A place is none for the same proof with one, and one that is free is looked for without it.
    Returns how many boxes were looked at.
    """
    mode, length = flank
    body, f, t, point, intervals, workspace = np.empty(BODY), np.empty(3), np.empty(3), np.empty(3), np.empty((64, 2)), scratch()
    for i in range(len(rows)):
        p, n, a = contacts.point[rows[i]], contacts.normal[rows[i]], axis[i]
        cosine = dot(a, n)
        for k in range(3):
            f[k] = a[k] - cosine * n[k]
        sine = np.sqrt(dot(f, f))
        for k in range(3):
            f[k] /= sine
        cross(n, f, t)
        state[i] = NONE
        for j in range(len(away)):
            for k in range(3):
                # Across the axis, out of the material.
                point[k] = p[k] + away[j] * (sine * n[k] - cosine * f[k])
            frame, turn = Frame(point, n, f, t), (cosine, sine)
            here, slide, why, most = _slid(frame, turn, length, tool, mode, solids, within, hint[i], body, intervals, workspace)
            if here != NONE and hint[i] >= 0:
                here, slide, why, most = _slid(frame, turn, length, tool, mode, solids, within, -1, body, intervals, workspace)
            hint[i] = most
            if j == 0:
                reason[i] = why
            if here == UNKNOWN:
                state[i] = UNKNOWN
            if here == FREE:
                state[i] = FREE
                for k in range(3):
                    shift[i, k] = point[k] - slide * f[k] - p[k]
                break
    return workspace.looked[0]
