"""What every stage judges under: obstacles and what they enclose, faces chosen, spacing, conditions, threads.

May use: domain, kernels, and `cad_io`.
"""
