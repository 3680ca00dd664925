"""One narrator: each fact of a plan is put into words here, once, and whoever shows a plan shows these."""
