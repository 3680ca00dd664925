"""Compiled kernels: plain numbers and arrays in, numbers and arrays out. The only importer of numba.

The kernel language: scalar functions over float64, C-ordered arrays made by the caller, no Python objects, no
`fastmath` (it breaks `isnan`), no parallel loops (callers share chunks out over threads; the GIL is released).
Lengths mm, angles rad. Words as in `docs/method.md`: contact P, tool axis a, x_T from the bottom centre to P, y_T = a x x_T.
"""
