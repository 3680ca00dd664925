"""The FreeCAD workbench of plan-cutters: which cutters can finish the picked faces.

It runs in FreeCAD's own Python and imports nothing of the program, which is a process of its own (`runner`). What people see is
`panel` and `init_gui`; `model`, `runner`, `results` and `objects` work without a window, and `host` is all that differs between
releases of FreeCAD.
"""

__version__ = "0.1.0"
