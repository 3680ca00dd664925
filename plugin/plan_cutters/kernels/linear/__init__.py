"""Vectors, the tree of obstacles' boxes, and eight boxes or triangles of it at a time."""
