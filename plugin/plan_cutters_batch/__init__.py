"""Many parts on many machines: what is to be planned, where it runs, what is kept, and the table of all."""
