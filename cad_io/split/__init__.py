"""Faces cut along the boundaries of labels on them, and checked.

May use: single faces and the kernel's manners.
"""

from cad_io.split.pieces import split, split_by_turns

__all__ = ["split", "split_by_turns"]
