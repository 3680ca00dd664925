"""A split part as STEP or GLB, whole or not at all.

May use: what splits, and the kernel's manners.
"""

from cad_io.write.gltf import meshes_of, write_gltf
from cad_io.write.step import write_step

__all__ = ["meshes_of", "write_gltf", "write_step"]
