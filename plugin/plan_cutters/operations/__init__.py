"""The plan of operations: fixed orientations, cutters and setups that finish together all that can be reached, with proofs.

The derivation is in `docs/operations.md`. One module for each step: columns that may be chosen (`candidates`), where each of them
serves (`probes`), the fewest of them with a certificate (`fewest`, `cover`), and the entries of the plan file (`entries`).
"""
