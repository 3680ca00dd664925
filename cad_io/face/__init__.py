"""One face: its trim, the region of the parameter plane that it covers, its curvature, area and shape.

May use: the kernel's manners.
"""
