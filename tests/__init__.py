"""Tests, in folders named after the rooms that they test; `support` holds their helpers."""
