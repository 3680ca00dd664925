"""The two decorators of kernels (`cad_io.jit`), with a cache folder for just these sources."""

from cad_io.jit import VERSION, decorators

__all__ = ["VERSION", "entry", "kernel"]

entry, kernel = decorators(__file__)
