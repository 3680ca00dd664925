"""Objects of the document that show a result: saved with it, made in one step to undo."""

from __future__ import annotations

from . import results


def show(document, result: results.Result, cutter: str = ""):
    """Show a result; the group of its objects. What an earlier plan of the same body shows is taken away."""
    raise NotImplementedError


def clear(document) -> int:
    """Take away what plans show in a document, and show the bodies again; how many plans that were."""
    return 0


def plans(document) -> list:
    """Groups that show plans in a document."""
    return []


def result_of(group) -> results.Result:
    """The result that a group shows, also after the document was saved and opened again."""
    raise NotImplementedError


def stale(group) -> str:
    """Why a group does not show the body as it is now; empty where it does."""
    return ""


def put_tool(group, spot: results.Spot):
    """Show the tool assembly of a cutter at a worst spot; its object, which each further spot moves."""
    raise NotImplementedError


def nearest(group, point) -> dict:
    """The sample nearest to a picked point: face, point, verdict, reason, axis and rotary angles for the shown cutter."""
    raise NotImplementedError
