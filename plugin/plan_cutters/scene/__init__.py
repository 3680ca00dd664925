"""Every stage judges in this scene: obstacles and the bodies they enclose, chosen faces, spacing, conditions, threads.

May use: domain, kernels, and `cad_io`.
"""
