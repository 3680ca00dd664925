"""The kernel's manners: its calls and their errors, its maps and numbers, compounds, places of products, time limits.

May use: arrays and errors.
"""

from cad_io.kernel.calls import (
    along,
    bounding,
    domain,
    edges_of,
    explore,
    faces,
    first_derivatives,
    interval_ends,
    is_kernel_error,
    may_refuse,
    points_on,
    second_derivatives,
    shape_map,
    silence,
    translated,
    values,
)

__all__ = [
    "along",
    "bounding",
    "domain",
    "edges_of",
    "explore",
    "faces",
    "first_derivatives",
    "interval_ends",
    "is_kernel_error",
    "may_refuse",
    "points_on",
    "second_derivatives",
    "shape_map",
    "silence",
    "translated",
    "values",
]
