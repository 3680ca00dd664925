"""Results as build123d compounds with labels and colours."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plan_cutters.document.model import WitnessEntry
    from plan_cutters.result import Result


def compound(result: "Result", *, at: "int | WitnessEntry | None" = None, cutter: str | None = None) -> Any:
    """A result as a build123d compound, for ocp_vscode and export.

    What is in it is what `hosts.cadquery.assembly` holds, with the same names as labels.

    Parameters
    ----------
    result : Result
    at : int or WitnessEntry, optional
        The row of a sample, or a witness such as `result.face("F3").worst`: there the tool assembly is put.
    cutter : str, optional
        Id of the one whose verdicts and tool are shown; default `result.shown`.

    Returns
    -------
    build123d.Compound
        Its children are compounds `targets`, `check faces`, `ignored faces`, `fixtures`, `tool <id>`, as far as there are any.

    Raises
    ------
    OptionError
        No posture is known at that sample.
    """
    import build123d

    from plan_cutters.hosts.viewer import shown

    name, groups = shown(result, at, cutter)

    def made(each: Any) -> Any:
        shape = build123d.Shape.cast(each.shape)
        shape.label, shape.color = each.name, build123d.Color(*each.colour)
        return shape

    inner = [
        build123d.Compound(label=group, children=[made(each) for each in shapes]) for group, shapes in groups.items()
    ]
    return build123d.Compound(label=name, children=inner)
