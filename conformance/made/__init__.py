"""Parts whose answers are closed forms, one module a family."""
