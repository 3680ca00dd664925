"""The tolerance rule: what a gouge tolerance and the chord error of triangles let be called safe, and prove to be blocked.

Every point of the surface has a point of the triangles within their chord error, and the reverse. All that judges takes its
depths from here.
"""

#: Share of the tolerance that the obstacles' chord error may take, and what is asked of the tessellation.
CHORD_SHARE, CHORD_REQUESTED = 0.25, 0.2
#: Verdicts say something about a cutter whose radius and flutes' length the tolerance is a smaller share of.
JUDGED_SHARE = 0.25
#: Of a nominal answer, mm.
_HAIR = 1e-9


def depths(tolerance: float, chord_error: float) -> tuple[float, float]:
    """Depths that are safe and that are blocked, mm, for the true surface: negative within that distance.

    If no triangle reaches deeper than the first, no point of the surface is deeper than the tolerance; a point of a triangle that
    is deeper than the second proves one. Of what may not be touched at all the tolerance is 0.

    Parameters
    ----------
    tolerance : float
        Depth that is allowed, mm.
    chord_error : float
        Of the triangles, mm.

    Examples
    --------
    >>> depths(0.5, 0.125), depths(0.0, 0.125)
    ((0.375, 0.625), (-0.125, 0.125))
    """
    return tolerance - chord_error, tolerance + chord_error


def effective_tolerance(requested: float, chord_error: float) -> float:
    """The gouge tolerance that is kept, mm: the one requested or, where triangles cannot be that close, more.

    >>> effective_tolerance(0.01, 0.0025), effective_tolerance(0.01, 0.01)
    (0.01, 0.04)
    """
    return max(requested, chord_error / CHORD_SHARE)


def nominal_depth(chord_error: float) -> float:
    """Depth up to which nothing counts for the answer without a tolerance, mm.

    Next to the contact, where the true clearance is zero, triangles must not count; local gouging does.
    """
    return 2 * chord_error + _HAIR
