"""All faces of a part: their numbers, what they enclose, which side of each is out, and what was sewn to tell.

May use: single faces and the kernel's manners.
"""

from cad_io.part.part import Part

__all__ = ["Part"]
