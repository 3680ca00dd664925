"""Files that others wrote, read safely: never more than they can sensibly be, never other files or entities on their behalf.

May use: errors. Tool libraries and machine files are read through it; which of both it is says the class of `Content`.
Archives of arrays are read through `Archive`.
"""
