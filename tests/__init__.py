"""Tests, in folders named after the rooms that they test; `support` holds their helpers."""

import os
import platform

# Before numpy is loaded: its products and sines round in another way on each kind of processor, and the last bit decides which of
# two postures is found first. With what all x86 processors have, what is kept (`tests/*/kept`) is the same on all.
if platform.machine() in ("x86_64", "AMD64"):
    os.environ.setdefault("OPENBLAS_CORETYPE", "Prescott")
    os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", "X86_V4 AVX512_ICL AVX512_SPR")
