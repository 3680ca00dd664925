"""Number the faces of a part, and find the volumes that they enclose and the outer side of each, by sewing where needed.

May use: single faces and the kernel's manners.
"""

from cad_io.part.part import Part

__all__ = ["Part"]
