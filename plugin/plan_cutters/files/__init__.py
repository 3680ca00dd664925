"""Files that others wrote, read safely: never more than they can sensibly be, never other files or entities on their behalf.

May use: errors. Tool libraries and machine files are read through `Content`, archives of arrays are read through `Archive`.
"""
