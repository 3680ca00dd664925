"""Faces by verdict: the pieces of the annotated model, or whole faces by their worst verdict where these cannot be told."""

from __future__ import annotations

from . import host, results
from .words import tr


def by_verdict(result: results.Result, shape, cutter: str) -> dict[str, tuple[list, list[int]]]:
    """Faces of each verdict, and the numbers of the body's faces that they are of; worst verdict first.

    Parameters
    ----------
    result : results.Result
    shape : Part.Shape
        The body where it stands.
    cutter : str
        The annotated model is about the cutter that the plan shows: for another one whole faces are taken.
    """
    rows = None
    if cutter == result.shown()["id"]:
        rows = _of_model(result, len(shape.Faces))
    if rows is None:
        words = result.verdicts(cutter)
        rows = [(number, word, face) for number, (word, face) in enumerate(zip(words, shape.Faces), 1)]
        entry = result.shown(cutter)
        label = entry["name"] or entry["id"]
        host.say(tr("{cutter}: each face has the colour of the worst verdict on it").format(cutter=label))
    found: dict[str, tuple[list, list[int]]] = {}
    for word in (*results.WORST_FIRST, *sorted({row[1] for row in rows} - set(results.WORST_FIRST))):
        mine = [(number, face) for number, each, face in rows if each == word]
        if mine:
            found[word] = [face for _, face in mine], [number for number, _ in mine]
    return found


def not_shown(result: results.Result, found: dict[str, tuple[list, list[int]]], cutter: str) -> list[str]:
    """Verdicts of samples of a face that no piece of it has, as `F3 inaccessible (4 samples)`; worst first."""
    counts = result.shown(cutter)["faces"]
    return [
        f"{face} {word.replace('_', ' ')} ({mine[word]} samples)"
        for word in results.WORST_FIRST
        for face, mine in counts.items()
        if mine.get(word) and int(face[1:]) not in found.get(word, ([], []))[1]
    ]


def _of_model(result: results.Result, count: int) -> list[tuple[int, str, object]] | None:
    """Number, verdict and face of each piece of the annotated model; None where that is not about all faces."""
    if "step" not in result.paths:
        return None
    try:
        macro = host.operations_macro()
    except OSError:
        host.warn(tr("PlanOperations.FCMacro is not beside the add-on: copy the whole folder"))
        return None
    try:
        _, faces, names = macro.pieces(result.paths["step"])
    except macro.NotOpened as error:
        host.warn(str(error))
        return None
    rows = [(name[0], name[1], face) for name, face in zip(names, faces) if name is not None]
    known = {row[0] for row in rows} == set(range(1, count + 1)) and {row[1] for row in rows} <= set(result.plan["legend"])
    return rows if known else None
