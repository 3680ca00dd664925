"""Operations of a plan as coordinate systems with +Z along the tool axis, each with its faces; and a CAM job of them."""

from __future__ import annotations

from . import host, model, results
from .words import tr

#: Models of the plans of operations in their order, as `files` of the plan names them.
MODELS = ("operations_step", "fastest_step")


def add(document, group, result: results.Result) -> None:
    """Put the operations of a plan into its group; where their model cannot be read, a line says so."""
    entry = result.plan.get("operations")
    for plan, word in zip(entry["plans"] if entry else (), MODELS):
        if word not in result.paths:
            host.warn(tr("the {plan} plan of operations has no model: it is not shown").format(plan=plan["name"]))
            continue
        before = {each.Name for each in document.Objects}
        try:
            macro = host.operations_macro()
            shape, faces, names = macro.pieces(result.paths[word], macro.called(result.plan, plan))
            part, _, _ = macro.show(document, result.plan, plan, shape, faces, names)
        except Exception as error:  # also what the macro and the kernel raise
            host.warn(tr("the {plan} plan of operations is not shown: {error}").format(plan=plan["name"], error=error))
            for name in {each.Name for each in document.Objects} - before:
                document.removeObject(name)
            continue
        # The body itself and the fixtures are in the document.
        document.removeObject(part.Name)
        holder = document.addObject("App::DocumentObjectGroup", "Plan_operations")
        holder.Label = f"operations: {plan['name']}"
        holder.addProperty("App::PropertyString", "PlanModel", "Plan", "Which model they are from")
        holder.PlanModel = word
        group.addObject(holder)
        for each in [each for each in document.Objects if each.Name not in before and each is not holder]:
            if each.Label.startswith("Fixtures") and each.isDerivedFrom("Part::Feature"):
                document.removeObject(each.Name)
            elif not each.InList:
                holder.addObject(each)
        for each in holder.OutListRecursive:
            if each.isDerivedFrom("Part::Feature") and hasattr(each, "Shape") and each.Shape.Faces:
                host.visible(each, False)  # the verdicts are shown there


def own_bits(document, result: results.Result) -> dict:
    """The tool bits of the document that cutters of a plan were read from, by the ids of the cutters.

    A bit that has another diameter or other flutes than its cutter was changed after the plan, and is none of them.
    """
    found = {}
    for bit in filter(None, map(document.getObject, result.job.tools.bits)):
        if not host.bit_shape(bit):
            continue
        for cutter in result.plan["cutters"]:
            names = {cutter["name"], *(each["name"] for each in cutter.get("sources") or ())}
            sizes = {"Diameter": 2.0 * cutter["radius"], "CuttingEdgeHeight": cutter["flutes_mm"] or cutter["length"]}
            same = all(abs(getattr(getattr(bit, word, None), "Value", size) - size) < 1e-3 for word, size in sizes.items())
            if bit.Label in names and same and cutter["id"] not in found:
                found[cutter["id"]] = bit
    return found


def make_job(group, word: str = MODELS[0]):
    """A CAM job of a plan's operations: tool controllers, and work planes where operations of this FreeCAD know them.

    The job and the model that it is about are yours: they stay when the plan is cleared.

    Raises
    ------
    Refused
        The plan has no operations, or this FreeCAD makes no job.
    """
    from . import objects

    why = objects.stale(group)
    if why:
        raise model.Refused(why)
    document, result = group.Document, objects.result_of(group)
    holder = next((each for each in group.Group if getattr(each, "PlanModel", "") == word), None)
    if holder is None or word not in result.paths:
        raise model.Refused(tr("this plan shows no operations: choose some in “Operations” and plan again"))
    plan = result.plan["operations"]["plans"][MODELS.index(word)]
    macro = host.operations_macro()
    with objects.step(document, tr("Job of a plan")):
        try:
            shape, faces, names = macro.pieces(result.paths[word], macro.called(result.plan, plan))
            part = document.addObject("Part::Feature", "Part")
            part.Label = result.plan["part"]["file"]
            part.Shape = macro.body(shape, names)
        except macro.NotOpened as error:
            raise model.Refused(str(error)) from None
        planes = {}
        for entry, each in zip(plan["operations"], [each for each in holder.Group if hasattr(each, "Mode")]):
            planes[entry["id"]] = next((child for child in each.Group if "_plane" in child.Name), None)
        for number, each in zip(macro.drilling(result.plan), [each for each in holder.Group if hasattr(each, "Kind")]):
            planes[f"drill{number}"] = next((child for child in each.Group if "_plane" in child.Name), None)
        taken = {
            entry["id"]: [place for place, name in enumerate(names) if name is not None and name[1] == entry["id"]]
            for entry in plan["operations"]
        }
        taken.update(macro.bored(result.plan, faces, names))
        order = [place for place, name in enumerate(names) if name is not None]
        document.recompute()
        shown = (part, planes, taken, {place: n for n, place in enumerate(order, 1)})
        job = macro.tried_job(document, result.plan, plan, shown, own_bits(document, result))
        if job is None:
            raise model.Refused(tr("this FreeCAD made no CAM job: the report view says why"))
        host.visible(part, False)
    document.recompute()
    return job
