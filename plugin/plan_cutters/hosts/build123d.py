"""Results as build123d compounds with labels and colours."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import WitnessEntry
    from plan_cutters.result import Result


def compound(result: "Result", *, at: "int | WitnessEntry | None" = None, cutter: str | None = None) -> Any:
    """A result as a build123d compound, for ocp_vscode and export.

    What it takes, holds and raises is as of `hosts.cadquery.assembly`, with the same names as labels.
    """
    import build123d

    from plan_cutters.hosts.viewer import shown

    name, groups = shown(result, at, cutter)

    def made(each: Any) -> Any:
        shape = build123d.Shape.cast(each.shape)
        shape.label, shape.color = each.name, build123d.Color(*each.colour)
        return shape

    inner = [build123d.Compound(label=group, children=[made(each) for each in shapes]) for group, shapes in groups.items()]
    return build123d.Compound(label=name, children=inner)
