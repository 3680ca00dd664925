"""Compiled kernels: plain numbers and arrays in, numbers and arrays out. Compiled by `plan_cutters_base.jit`.

The kernel language: scalar functions over float64, C-ordered arrays made by the caller, no Python objects, no
`fastmath` (it breaks `isnan`), no parallel loops (callers share chunks out over threads; the GIL is released).
Lengths mm, angles rad. The contact is P, the tool axis a, x_T points from the bottom centre to P, y_T = a x x_T.
"""
