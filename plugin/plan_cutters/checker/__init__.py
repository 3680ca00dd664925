"""A checker of written plans of operations, which shares nothing with the search that makes them.

It imports the CAD boundary, and of this package the errors alone.
"""
