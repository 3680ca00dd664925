"""Values and derivatives of surfaces without a call of the kernel a point; the kernel is the reference, and does the rest.

May use: the compiler, arrays and the kernel's manners.
"""

from cad_io.surface.elementary import Bends
from cad_io.surface.surface import Surface

__all__ = ["Bends", "Surface"]
