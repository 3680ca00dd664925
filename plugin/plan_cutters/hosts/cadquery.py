"""A planning step in CadQuery chains: `register()`, then `Workplane(...).plan_cutters(...)`."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plan_cutters.result import Result


def register() -> None:
    """Add `plan_cutters` to `cadquery.Workplane`; it takes the options of `plan_cutters.plan`, returns its Result.

    Faces on the stack are the targets, judged in the solid of the chain that holds them: after `.faces(">Z")` the top is
    machined and all else is in the way. With solids on the stack, `faces=` says what the targets are.
    """
    import cadquery

    def step(self: Any, **options: Any) -> "Result":
        from plan_cutters.pipeline import plan

        return plan(self, **options)

    cadquery.Workplane.plan_cutters = step
