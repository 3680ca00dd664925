"""A checker of written plans of operations, which shares nothing with the search that makes them.

It imports the CAD boundary and the errors; its command alone takes options, as every command does.
"""
