"""What knows no CAD and no cutter: processes and their ends, compiling, fingerprints, files that appear whole, kept work."""
