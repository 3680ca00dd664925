"""A planning step in CadQuery chains, and results as coloured assemblies."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import WitnessEntry
    from plan_cutters.result import Result

#: How a selector of CadQuery begins that is none of our own words.
_SELECTOR = tuple("<>|#+-%(")


def register() -> None:
    """Add `plan_cutters` to `cadquery.Workplane`; it takes the options of `plan_cutters.plan`, returns its Result.

    Faces on the stack are the targets, judged in the solid of the chain that holds them: after `.faces(">Z")` the top is
    machined and all else is in the way. With solids on the stack, `faces=` says what the targets are; there it may be a
    CadQuery selector, too, as a text such as `">Z"` or an object.
    """
    import cadquery

    def step(self: Any, **options: Any) -> "Result":
        from plan_cutters.calls import plan

        faces = options.get("faces")
        if isinstance(faces, cadquery.Selector) or (isinstance(faces, str) and faces.strip().startswith(_SELECTOR)):
            options["faces"] = self.faces(faces)
        return plan(self, **options)

    cadquery.Workplane.plan_cutters = step


def assembly(result: "Result", *, at: "int | WitnessEntry | None" = None, cutter: str | None = None) -> Any:
    """A result as a CadQuery assembly, for CQ-editor, ocp_vscode and export.

    Target faces are split along the boundaries of the verdicts; every piece is a child called `F<number>_<verdict>` with the
    colour of its verdict. Check faces keep their colours. Fixtures stand where they were.

    Parameters
    ----------
    result : Result
    at : int or WitnessEntry, optional
        The row of a sample, or a witness such as `result.face("F3").worst`: there the tool assembly is put.
    cutter : str, optional
        Id of the one whose verdicts and tool are shown; default `result.shown`.

    Returns
    -------
    cadquery.Assembly
        Children `targets`, `check faces`, `ignored faces`, `fixtures`, `tool <id>`, as far as there are any.

    Raises
    ------
    OptionError
        No posture is known at that sample.
    """
    import cadquery

    from plan_cutters.hosts.viewer import shown

    name, groups = shown(result, at, cutter)
    whole = cadquery.Assembly(name=name)
    for group, shapes in groups.items():
        inner = cadquery.Assembly(name=group)
        for each in shapes:
            inner.add(cadquery.Shape.cast(each.shape), name=each.name, color=cadquery.Color(*each.colour))
        whole.add(inner)
    return whole
