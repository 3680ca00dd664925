"""Triangles close to a part, with the distance that was measured, and what stands in for a face that has none.

May use: parts, and what is below them.
"""

from cad_io.tessellate.triangles import tessellate

__all__ = ["tessellate"]
