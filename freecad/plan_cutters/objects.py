"""Objects of the document that show a result: saved with it, made in one step to undo."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import shutil
from collections.abc import Iterator

import Part

from . import host, model, operations, pieces, results, runner, tool
from .words import tr

#: The property that tells a group of ours, and those that hold files of the plan.
JOB = "PlanJob"
FILES = {
    "json": "PlanFile",
    "npz": "SamplesFile",
    "html": "ReviewFile",
    "step": "ModelFile",
    "operations_step": "OperationsFile",
    "fastest_step": "FastestFile",
}
#: Of a child of a group: what it is for.
ROLE = "PlanRole"


@contextlib.contextmanager
def step(document, words: str) -> Iterator[None]:
    """One step to undo. Where it fails nothing that it made is left."""
    inside = document.HasPendingTransaction
    before = {each.Name for each in document.Objects}
    if not inside:
        document.openTransaction(words)
    try:
        yield
    except BaseException:
        if not inside:
            document.abortTransaction()
        # Without a record of steps there is nothing that was taken back.
        _removed(document, {each.Name for each in document.Objects} - before)
        raise
    if not inside:
        document.commitTransaction()


def _removed(document, names) -> None:
    for name in names:
        if document.getObject(name) is not None:
            document.removeObject(name)


def _note(thing, kind: str, name: str, value, words: str = "") -> None:
    """A property with what the plan says."""
    if name not in thing.PropertiesList:
        thing.addProperty(f"App::Property{kind}", name, "Plan", words)
    setattr(thing, name, value)


def show(document, result: results.Result, cutter: str = ""):
    """Show a result in its document, in the place of the body.

    What an earlier plan of the same body shows is taken away. The files of the result are in the document then, and no
    longer in the temporary folder.

    Parameters
    ----------
    document : App.Document
        That of the job.
    result : results.Result
    cutter : str
        Id of the cutter that the colours are about; empty: the one that the plan shows.

    Returns
    -------
    App.DocumentObjectGroup
        An object for each verdict, with the colour that the legend gives it.

    Raises
    ------
    Refused
        The body is gone or another one than was planned.
    """
    if document.Name != result.job.document:
        raise model.Refused(
            tr("the plan is about the document {document}, not {name}").format(document=result.job.document, name=document.Name)
        )
    changed = _changed(result)
    if changed:
        raise model.Refused(tr("{changed} while it was planned: plan again").format(changed=changed))
    thing = model.thing_of(document.Name, result.job.body)
    if len(result.plan["faces"]) != len(model.shape_of(thing).Faces):
        raise model.Refused(
            tr("the plan has {count} faces, {label} another number of them").format(
                count=len(result.plan["faces"]), label=thing.Label
            )
        )
    entry = result.shown(cutter)
    if not result.folder:
        result = _copied(result)
    with step(document, tr("Plan cutters")):
        old = [each for each in plans(document) if json.loads(getattr(each, JOB))["body"] == thing.Name]
        seen = host.visible(thing) or any(each.BodyWasVisible and not each.OutOfDate for each in old)
        for each in old:
            _taken_away(document, each)
        group = document.addObject("App::DocumentObjectGroup", "Plan")
        group.Label = f"{thing.Label}: {entry['name'] or entry['id']}"
        asked = {**dataclasses.asdict(result.job), "fingerprints": result.fingerprints}
        _note(group, "String", JOB, json.dumps(asked), "What was asked")
        _note(group, "String", "Cutter", entry["id"], "The colours are about it")
        _note(group, "String", "Headline", result.headline(), "The verdict")
        _note(group, "StringList", "Summary", result.summary(), "What the plan says")
        _note(group, "String", "OutOfDate", "", "Why the colours were dropped")
        _note(group, "Bool", "BodyWasVisible", seen)
        same = [each for each in model.copied_from(thing) if host.visible(each)]
        _note(group, "StringList", "AlsoHidden", [each.Name for each in same], "Bodies that would cover the colours")
        for word, name in FILES.items():
            if word in result.paths:
                _note(group, "FileIncluded", name, result.paths[word], "A file of the plan")
        found = pieces.by_verdict(result, model.shape_of(thing), entry["id"])
        for word, (faces, numbers) in found.items():
            group.addObject(_verdict(document, result, word, faces, numbers))
        missing = pieces.not_shown(result, found, entry["id"])
        _note(group, "StringList", "NotShown", missing, "Verdicts on a face that no object shows")
        if missing:
            host.warn(
                tr("without a colour of their own, for they are too small or whole faces are coloured: {names}").format(
                    names=", ".join(missing)
                )
            )
        operations.add(document, group, result)
        for each in (thing, *same):
            host.visible(each, False)
    document.recompute()
    result.discard()
    return group


def _copied(result: results.Result) -> results.Result:
    """The same with files of its own: a document would move those that are in another group."""
    folder = runner.folder()
    paths = {word: shutil.copy(path, folder) for word, path in result.paths.items()}
    return dataclasses.replace(result, paths=paths, folder=folder)


def _verdict(document, result: results.Result, word: str, faces, numbers):
    """An object of all that has one verdict."""
    words, colour = next((text, colour) for code, text, colour in result.legend() if code == word)
    thing = document.addObject("Part::Feature", f"Plan_{word}")
    thing.Label = words
    thing.Shape = Part.Compound(faces)
    _note(thing, "String", ROLE, "verdict")
    _note(thing, "String", "Verdict", word, "Code in plan.json")
    _note(thing, "Color", "Colour", colour, "In the legend")
    _note(thing, "StringList", "Faces", [f"F{number}" for number in numbers], "Face of the body, of each face of this object")
    host.paint(thing, colour)
    return thing


def plans(document) -> list:
    """Groups that show plans in a document."""
    return [each for each in document.Objects if JOB in each.PropertiesList]


def result_of(group) -> results.Result:
    """The result that a group shows, also after the document was saved and opened again."""
    asked = json.loads(getattr(group, JOB))
    fingerprints = asked.pop("fingerprints")
    # A document that is opened may have another name.
    job = dataclasses.replace(model.job_of(asked), document=group.Document.Name)
    paths = {word: getattr(group, name, "") for word, name in FILES.items()}
    paths = {word: path for word, path in paths.items() if path}
    return results.Result(results.parsed(paths.get("json", "")), job, fingerprints, paths)


def body_of(group):
    """The body that a group is about.

    Raises
    ------
    Refused
        It is gone.
    """
    return model.thing_of(group.Document.Name, json.loads(getattr(group, JOB))["body"])


def _changed(result: results.Result) -> str:
    """What of a job's bodies is no longer as it was, in words; empty where all are."""
    for name, print_ in result.fingerprints.items():
        try:
            thing = model.thing_of(result.job.document, name)
            if model.fingerprint(model.shape_of(thing)) != print_:
                return tr("{label} was changed").format(label=thing.Label)
        except model.Refused as error:
            return str(error)
    return ""


def stale(group) -> str:
    """Why a group does not show the body, or its fixtures, as they are now; empty where it does."""
    if group.OutOfDate:
        return group.OutOfDate
    changed = _changed(result_of(group))
    return tr("{changed} after the plan: plan again").format(changed=changed) if changed else ""


def clear(document) -> int:
    """Take away what plans show in a document, and show the bodies again; how many plans that were."""
    groups = plans(document)
    if groups:
        with step(document, tr("Clear plans")):
            for group in groups:
                _taken_away(document, group)
        document.recompute()
    return len(groups)


def _taken_away(document, group) -> None:
    """Remove a group with all in it, and show its body as before."""
    _shown_again(group)
    _removed(document, [*_within(group), group.Name])


def _shown_again(group) -> None:
    if group.OutOfDate:
        return
    for each in _also_hidden(group):
        host.visible(each, True)
    if group.BodyWasVisible:
        with contextlib.suppress(model.Refused):
            host.visible(body_of(group), True)


def _also_hidden(group) -> list:
    """Bodies beside the planned one that are hidden as long as the colours are shown."""
    return [each for each in map(group.Document.getObject, getattr(group, "AlsoHidden", ())) if each is not None]


def _within(group) -> list[str]:
    """Names of all that is in a group, the innermost first."""
    found = []
    for each in group.Group:
        if each.isDerivedFrom("App::DocumentObjectGroup"):
            found += _within(each)
        found.append(each.Name)
    return found


def drop(group, why: str) -> None:
    """Take away the colours, the tool and the operations of a plan that is out of date, and say so.

    The group stays with what the plan said.
    """
    with step(group.Document, tr("Plan is out of date")):
        _removed(group.Document, _within(group))
        _shown_again(group)
        group.OutOfDate = why
        group.Label = f"{group.Label} (out of date)"
    host.warn(tr("{why}. The colours of {label} were dropped").format(why=why, label=group.Label))


def put_tool(group, spot: results.Spot | results.Sample):
    """Show the tool assembly of a cutter at a spot; its object, which each further spot moves.

    Raises
    ------
    Refused
        No posture is known there, or the plan does not say the shape of the tool.
    """
    why = stale(group)
    if why:
        raise model.Refused(why)
    entry = result_of(group).shown(spot.cutter)
    if spot.axis is None:
        raise model.Refused(
            tr("no posture of {cutter} is known at {face}: there is no tool to show").format(cutter=spot.cutter, face=spot.face)
        )
    document = group.Document
    found = tool_of(group)
    with step(document, tr("Tool at a spot")):
        if found is None:
            found = document.addObject("Part::Feature", "Plan_tool")
            _note(found, "String", ROLE, "tool")
            group.addObject(found)
        if getattr(found, "Cutter", "") != entry["id"]:
            try:
                found.Shape, parts = tool.assembly(entry)
            except ValueError as error:
                raise model.Refused(str(error)) from None
            _note(found, "String", "Cutter", entry["id"])
            found.Label = f"tool {entry['name'] or entry['id']}"
            counts = [len(solid.Faces) for solid in found.Shape.Solids]
            host.paint_faces(found, [tool.COLOURS[part] for part, count in zip(parts, counts) for _ in range(count)])
        if spot.tip is None:
            raise model.Refused(
                tr("the plan does not have the place of the tip of {cutter}: the review page shows it").format(cutter=spot.cutter)
            )
        found.Placement = tool.placement(spot.tip, spot.axis)
        host.visible(found, True)
    return found


def tool_of(group):
    """The tool that a plan shows; None where it shows none."""
    return next((each for each in group.Group if getattr(each, ROLE, "") == "tool"), None)


def hide_tool(group) -> None:
    """Take the tool of a group away."""
    names = [each.Name for each in group.Group if getattr(each, ROLE, "") == "tool"]
    if names:
        with step(group.Document, tr("Hide tool")):
            _removed(group.Document, names)


def nearest(group, point, cutter: str = "") -> results.Sample:
    """What the plan knows of the sample nearest to a picked point (mm), by default for the cutter of the colours."""
    return result_of(group).nearest(point, cutter or group.Cutter)


def repaint(document) -> None:
    """Give the objects of plans their colours, which a document that was made without a window does not hold."""
    for group in plans(document):
        for each in group.Group:
            if getattr(each, ROLE, "") == "verdict":
                host.paint(each, tuple(each.Colour[:3]))
        if not group.OutOfDate:
            with contextlib.suppress(model.Refused):
                for each in (body_of(group), *_also_hidden(group)):
                    host.visible(each, False)


def active(document) -> object | None:
    """The newest plan of a document whose colours are shown; None where there is none."""
    found = [group for group in plans(document) if not group.OutOfDate]
    return found[-1] if found else None
