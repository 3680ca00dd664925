"""The format: schemas and their check."""
